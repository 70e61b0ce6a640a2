#include <catch2/catch.hpp>

#include "io_fixture.hpp"
#include "lfdtools/io/demonstrations.hpp"

using namespace lfd;

namespace {

using Names = std::vector<std::string>;

struct Source {
  CapturedMessages captured;
  DemonstrationSource source;

  explicit Source(const std::string& text, const DemonstrationOptions& options = {})
      : source(CsvTable(inputs_of({text}), captured.messages), captured.messages, options) {}
};

Refusal refusal_for(const std::string& text, const DemonstrationOptions& options = {}) {
  return refusal_of([&] {
    const Source s(text, options);
    for (std::size_t i = 0; i < s.source.pools(); ++i) (void)s.source.pool(i);
  });
}

void require_refused(const std::string& text, const std::string& id, std::size_t line) {
  INFO(text);
  const Refusal refusal = refusal_for(text);
  REQUIRE(refusal.id == id);
  REQUIRE(refusal.fault == Fault::data);
  REQUIRE(refusal.place.line == line);
}

std::string warnings_for(const std::string& text) {
  const Source s(text);
  for (std::size_t i = 0; i < s.source.pools(); ++i) (void)s.source.pool(i);
  return s.captured.text();
}

}  // namespace

TEST_CASE("signals are x, y, z if all are there, else every numeric column that is nothing else") {
  REQUIRE(Source("demo,t,force,z,y,x\n1,0,9,3,2,1\n").source.columns() == Names{"x", "y", "z"});
  REQUIRE(Source("target,t,x,y,force,note\n1,0,1,2,3,up\n").source.columns() == Names{"x", "y", "force"});
  REQUIRE(Source("t,q1,q2,qw,qx,qy,qz\n0,1,2,1,0,0,0\n").source.columns() == Names{"q1", "q2"});
  REQUIRE(Source("t,x,y,start_x,goal_x,sd_y,cov_x_y,cov_x_x,d_x,v_y,a_x\n0,1,2,1,1,1,1,1,1,1,1\n").source.columns() ==
          Names{"x", "y"});
  // A prefix alone makes no derived column.
  REQUIRE(Source("t,d_gripper,sd_a\n0,1,2\n").source.columns() == Names{"d_gripper", "sd_a"});
  REQUIRE(refusal_for("target,t,note\n1,0,up\n").id == "demo.no_signal");
  // A column whose first cell is empty or nan tries to be a number: it is refused, not passed over.
  REQUIRE(refusal_for("t,x,y\n0,1,\n1,2,3\n2,2,2\n").id == "csv.not_finite");
}

TEST_CASE("columns and extras are read by name") {
  DemonstrationOptions options;
  options.columns = {"y", "x"};
  options.extras = {"sd_x"};
  options.min_samples = 1;
  const Source s("demo,sd_x,x,y,t\n1,9,1,2,0\n", options);
  const Recording recording = s.source.recording(0);
  REQUIRE(recording.demonstration.trajectory.positions == (Samples(1, 2) << 2, 1).finished());
  REQUIRE(recording.extras(0, 0) == 9);
  REQUIRE(s.captured.text().empty());

  const auto with = [](const Names& columns) {
    DemonstrationOptions wanted;
    wanted.columns = columns;
    return refusal_for("demo,t,x\n1,0,1\n", wanted);
  };
  REQUIRE(with({"demo"}).id == "demo.bad_column");
  REQUIRE(with({"t"}).fault == Fault::usage);
  REQUIRE(with({"x", "x"}).id == "demo.bad_column");
  REQUIRE(with({"q"}).id == "csv.missing_column");
  REQUIRE(refusal_for("demo,x\n1,0\n").id == "csv.missing_column");
}

TEST_CASE("columns without a use are named in a note") {
  const Source s("demo,t,x,y,z,force,note\n1,0,1,2,3,4,up\n");
  REQUIRE(s.captured.text() == "prog:a.csv:1: note: columns without a use here: force, note [csv.ignored_columns]\n");
}

TEST_CASE("pools gather the demonstrations of a target and teacher") {
  DemonstrationOptions options;
  options.min_samples = 1;
  const Source s("target,teacher,demo,t,x\n1,ann,1,0,0\n2,ann,1,0,0\n1,ann,2,0,0\n1,bob,1,0,0\n", options);
  REQUIRE(s.source.recordings() == 4);
  REQUIRE(s.source.pools() == 3);
  Pool pool = s.source.pool(0);
  REQUIRE(pool.labels == Labels{"1", "ann", {}, {}});
  REQUIRE(pool.recordings.size() == 2);
  REQUIRE(pool.recordings[1].demonstration.labels == Labels{"1", "ann", "2", {}});
  REQUIRE(pool.recordings[1].place(0).line == 4);
  REQUIRE(s.source.pool(2).labels.teacher == "bob");
  const DemonstrationSet set = pool.take(s.source.columns());
  REQUIRE(set.columns == Names{"x"});
  REQUIRE(set.demonstrations.size() == 2);
}

TEST_CASE("time must rise") {
  require_refused("t,x\n0,1\n1,2\n0.5,3\n", "demo.time_falls", 4);
  require_refused("t,x\n0,1\n1,2\n1,3\n2,1\n", "demo.time_repeats", 4);
  require_refused("t,x\n5,1\n5,2\n5,3\n", "demo.time_constant", 2);
  require_refused("demo,t,x\n1,0,1\n1,1,2\n1,2,3\n2,0,1\n2,1,2\n", "demo.too_few_samples", 5);
  REQUIRE(refusal_for("demo,t,x\n7,0,1\n").text == "demo 7 needs at least 3 samples, and has 1");
}

TEST_CASE("identical rows are collapsed with a warning, and lines stay right") {
  const Source s("t,x\n0,1\n0,1\n1,2\n1,2\n1,2\n2,3\n");
  const Recording recording = s.source.recording(0);
  REQUIRE(recording.demonstration.trajectory.times == (Vector(3) << 0, 1, 2).finished());
  REQUIRE(recording.demonstration.trajectory.positions == (Samples(3, 1) << 1, 2, 3).finished());
  REQUIRE(recording.lines == std::vector<std::size_t>{2, 4, 7});
  REQUIRE(s.captured.text() ==
          "prog:a.csv:2: warning: 3 rows that repeat the row before are left out [demo.identical_rows]\n");
  require_refused("t,x\n5,1\n5,1\n5,1\n", "demo.too_few_samples", 2);
}

TEST_CASE("a gap, a period in other units and distant starts are warned of") {
  REQUIRE(warnings_for("t,x\n0,1\n0.01,1\n0.02,1\n0.03,1\n") == "");
  REQUIRE(warnings_for("t,x\n0,1\n1,1\n2,1\n12,1\n13,1\n") == "");  // ten periods are no gap yet
  REQUIRE(warnings_for("t,x\n0,1\n1,1\n2,1\n12.5,1\n13.5,1\n24.5,1\n") ==
          "prog:a.csv:5: warning: a gap of 10.5 s, over ten sampling periods, the first of 2 [demo.gap]\n");
  REQUIRE(warnings_for("t,x\n0,1\n8,1\n16,1\n24,1\n") ==
          "prog:a.csv:2: warning: the median sampling period is 8 s: are the times in milliseconds or nanoseconds? "
          "seconds are needed [demo.period]\n");
  const std::string near = "demo,t,x,y\n1,0,0,0\n1,1,9,9\n1,2,9,9\n2,0,0,0.02\n2,1,9,9\n2,2,9,9\n";
  REQUIRE(warnings_for(near) == "");
  const std::string far = "target,demo,t,x,y\n8,1,0,0,0\n8,1,1,9,9\n8,1,2,9,9\n8,2,0,0,0.025\n8,2,1,9,9\n8,2,2,9,9\n";
  REQUIRE(warnings_for(far) ==
          "prog:a.csv:5: warning: the starts of the demonstrations of target 8 lie up to 0.025 apart, "
          "over 0.02 [demo.starts_differ]\n");
}
