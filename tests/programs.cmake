# Tests of the programs as programs: cases (command, expected output and error), oracles (independent computations on the
# files that they write), and the layers of the sources. Included by tests/CMakeLists.txt.
set(LFD_PROGRAM_FOLDER ${CMAKE_BINARY_DIR}/tools)

foreach(program IN ITEMS demo-synth demo-align gmm-fit gmr-regress dmp-fit mvgpr-train skill-generate skill-validate
                         ur10-ik ur10-fk arm-clearance motion-compare skill-plot)
  add_test(NAME "cases: ${program}"
           COMMAND ${CMAKE_COMMAND} -E env "PATH=${LFD_PROGRAM_FOLDER}:$ENV{PATH}"
                   sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/run-cases.sh ${program})
  set_tests_properties("cases: ${program}" PROPERTIES TIMEOUT 120)
endforeach()

foreach(oracle IN ITEMS dtw gmm gmr dmp skill motion validation arm)
  add_test(NAME "oracle: ${oracle}"
           COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/oracle/${oracle}_oracle.py ${LFD_PROGRAM_FOLDER}
                   ${LFD_DATA_DIR} ${CMAKE_SOURCE_DIR}/share/lfdtools)
  set_tests_properties("oracle: ${oracle}" PROPERTIES TIMEOUT 300)
endforeach()

# The study on one layout, so that it cannot rot: it says its last line only if all went well.
foreach(part IN ITEMS layouts coverage)
  add_test(NAME "study: generalise ${part}"
           COMMAND ${CMAKE_COMMAND} -E env LFD_BUILD_DIR=${CMAKE_BINARY_DIR} LFD_LAYOUTS=1 LFD_SEEDS=1
                   LFD_OUT_DIR=${CMAKE_CURRENT_BINARY_DIR}/study
                   sh ${CMAKE_SOURCE_DIR}/share/lfdtools/study/generalise.sh ${part})
endforeach()
set_tests_properties("study: generalise layouts" PROPERTIES
                     PASS_REGULAR_EXPRESSION "best in hindsight +[0-9.]+ [^\n]*; [01]\n.*results: ")
set_tests_properties("study: generalise coverage" PROPERTIES
                     PASS_REGULAR_EXPRESSION "\\(predictive\\) +1 +[0-9.]+ %.*results: ")

# The check of hyperparameters on one fold of experiment A, with a few starts.
add_test(NAME "study: hyperparameters"
         COMMAND ${CMAKE_COMMAND} -E env LFD_BUILD_DIR=${CMAKE_BINARY_DIR} LFD_STARTS=20 LFD_FOLDS=1
                 LFD_OUT_DIR=${CMAKE_CURRENT_BINARY_DIR}/study PATH=${LFD_PROGRAM_FOLDER}:$ENV{PATH}
                 sh -c "demo-synth -q --repetitions 3 '${CMAKE_SOURCE_DIR}/share/lfdtools/peg-in-hole/A.json' -o study-A.csv &&
                        sh '${CMAKE_SOURCE_DIR}/share/lfdtools/study/hyperparameters.sh' study-A.csv"
         WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})

add_test(NAME "layers" COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/layers.sh ${CMAKE_SOURCE_DIR})

# Experiment B on one scene of each kind: the skill's motions are judged, and clear.
add_test(NAME "study: scenes"
         COMMAND ${CMAKE_COMMAND} -E env LFD_BUILD_DIR=${CMAKE_BINARY_DIR} LFD_ONE_WAY=1 LFD_TWO_WAYS=1
                 LFD_OUT_DIR=${CMAKE_CURRENT_BINARY_DIR}/study
                 sh ${CMAKE_SOURCE_DIR}/share/lfdtools/peg-in-hole/scenes/run.sh)
set_tests_properties("study: scenes" PROPERTIES TIMEOUT 300
                     PASS_REGULAR_EXPRESSION "round: 1 scenes.*\nskill +100[.]0 .*round: 1 scenes.*results: ")
