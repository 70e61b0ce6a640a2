# bash completion for lfdtools: options, choice words, gates, targets of --robot.  . lfdtools.bash
# In zsh: autoload -U +X bashcompinit && bashcompinit, then the same (or put _lfdtools on fpath).

_lfdtools_options() {
  local common="-o --output -q --quiet -v --verbose --errors --summary -h --help -V --version --strict"
  local table="--columns --renumber" gates="--no-gate --no-gates"
  case $1 in
    demo-synth) echo "$common --seed --write --no-obstacle --target --repetitions" ;;
    demo-align) echo "$common $table -j --jobs --reference --clock --window --trim --samples --leave-out-outliers --costs" ;;
    gmm-fit) echo "$common $table -j --jobs --seed -k --components --covariance-type --select --bic-n" \
                  "--bic-likelihood --restarts" ;;
    gmr-regress) echo "$common -n --samples --sd --covariance --derivatives" ;;
    dmp-fit) echo "$common $table $gates --paper -n --basis --alpha-z --beta-z --alpha-x --scaling --fit" ;;
    mvgpr-train) echo "$common $gates -j --jobs --seed --paper --model --inputs --kernel --mean --tempo --teachers" \
                      "--omega --process --calibration --leave-out-outliers --way --starts" ;;
    skill-generate) echo "$common $gates -j --jobs --seed --goal --goals --target --start --duration --dt --weights" \
                         "--derivatives --camera --via --goal-at --start-velocity --end-velocity --approach --sd" \
                         "--band --samples --covariance --max-sd" ;;
    skill-validate) echo "$common $table -j --jobs --seed --methods --road --folds --test --noise-free --repetitions" \
                         "--trim -n --basis -k --components --table --reliability --suggest" ;;
    skill-plot) echo "$common $table --kind --planes --title" ;;
    ur10-ik) echo "$common $gates --robot --orientation --rpy --tool --frame --seed-joints --start-tolerance --posture --given-rows" \
                  "--retime --acceleration --all --speeds --accelerations --diagnostics --singularities" \
                  "--max-tcp-speed --max-tcp-acceleration --max-condition" ;;
    ur10-fk) echo "$common --robot --tool --frame" ;;
    arm-clearance) echo "$common $gates --seed --scene --self --robot --margin --tool --tool-radius --covariance" \
                        "--goal-sd --frame --max-probability" ;;
    motion-compare) echo "$common $table --reference --duration -n --samples" ;;
  esac
}

# Words that the option $2 of the program $1 takes; status 1 where it takes a file name or is a flag, 2 where a number
# or a word of the user's own.
_lfdtools_words() {
  case $1:$2 in
    *:--errors) echo "text json" ;;
    demo-synth:--write) echo "demonstrations new-demonstrations intentions new-intentions holes new-holes" ;;
    demo-align:--reference) echo "medoid longest dba" ;;
    demo-align:--clock) echo "mean reference" ;;
    gmm-fit:--covariance-type) echo "full tied diagonal spherical" ;;
    gmm-fit:--select) echo "bic aic icl" ;;
    gmm-fit:--bic-n) echo "samples" ;;
    gmm-fit:--bic-likelihood) echo "samples effective" ;;
    dmp-fit:--scaling) echo "none goal" ;;
    dmp-fit:--fit) echo "trajectory ls lwr" ;;
    mvgpr-train:--model) echo "auto axis full joint" ;;
    mvgpr-train:--kernel) echo "auto sum additive se-ard matern32 matern52" ;;
    mvgpr-train:--mean) echo "auto zero constant linear line" ;;
    mvgpr-train:--tempo) echo "auto own shared" ;;
    mvgpr-train:--inputs) echo "auto change change+start" ;;
    mvgpr-train:--calibration) echo "targets none" ;;
    mvgpr-train:--teachers) echo "auto together apart" ;;
    mvgpr-train:--omega) echo "integrated ml" ;;
    mvgpr-train:--process) echo "gaussian student-t" ;;
    skill-validate:--methods) echo "skill skill-axis skill-full skill-joint skill-student-t paper paper-full line" \
                                   "nearest nearest-deviation mean mean-deviation moved-goal affine affine-means" \
                                   "affine-prior affine-ends gpr promp kmp" ;;
    skill-validate:--road) echo "recordings demonstrations references" ;;
    skill-plot:--kind) echo "auto motions planes time weights errors reliability" ;;
    skill-plot:--planes) echo "x-y y-z x-z x-y,y-z x-y,y-z,x-z" ;;
    *:--robot) echo "ur3 ur3e ur5 ur5e ur10 ur10e ur16e" ;;
    *:--frame) echo "base base_link" ;;
    dmp-fit:--no-gate) echo "goal_change" ;;
    mvgpr-train:--no-gate) echo "two_ways" ;;
    mvgpr-train:--way) echo "1 2" ;;
    skill-generate:--no-gate) echo "region start sd" ;;
    skill-generate:--sd) echo "latent predictive" ;;
    skill-generate:--band) echo "pointwise path" ;;
    skill-generate:--via | skill-generate:--goal-at | skill-generate:--*-velocity | skill-generate:--approach) return 2 ;;
    ur10-ik:--no-gate) echo "unreachable joint_range joint_step midpoint posture branch_change joint_speed joint_acceleration" \
                            "tcp_speed tcp_acceleration condition start" ;;
    arm-clearance:--no-gate) echo "clearance self_clearance probability mean_differs joint_range joint_step" ;;
    arm-clearance:--scene) echo "table peg-in-hole-B" ;;
    *:--margin | *:--tool-radius | *:--goal-sd) return 2 ;;
    *:-j | *:--jobs | *:--seed | *:--columns | *:--title | *:--target | *:--repetitions | *:--window | *:--samples | *:-n) return 2 ;;
    *:-k | *:--components | *:--restarts | *:--basis | *:--alpha-? | *:--beta-z | *:--starts | *:--goal | *:--start | *:--suggest) return 2 ;;
    *:--duration | *:--dt | *:--orientation | *:--rpy | *:--tool | *:--seed-joints | *:--start-tolerance | *:--acceleration | *:--max-*) return 2 ;;
    *) return 1 ;;
  esac
}

_lfdtools() {
  local program=${COMP_WORDS[0]##*/} word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD-1]} words found
  # --option=word comes as three words.
  if [ "$word" = "=" ]; then
    word=
  elif [ "$option" = "=" ] && [ "$COMP_CWORD" -ge 2 ]; then
    option=${COMP_WORDS[COMP_CWORD-2]}
  fi
  COMPREPLY=()
  words=$(_lfdtools_words "$program" "$option")
  found=$?
  if [ $found -eq 0 ]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  elif [ $found -eq 1 ] && [ "${word#-}" != "$word" ]; then
    COMPREPLY=($(compgen -W "$(_lfdtools_options "$program")" -- "$word"))
  fi
}

# Where there is nothing to say (files, numbers), bash offers file names.
complete -o bashdefault -o default -F _lfdtools arm-clearance demo-align demo-synth dmp-fit gmm-fit gmr-regress motion-compare \
  mvgpr-train skill-generate skill-plot skill-validate ur10-fk ur10-ik
