#include <catch2/catch.hpp>

#include "io_fixture.hpp"
#include "lfdtools/plot/error_picture.hpp"
#include "lfdtools/plot/picture.hpp"

using namespace lfd;
using namespace lfd::plot;

namespace {

Material read(const std::vector<std::string>& texts, const MaterialOptions& options = {}) {
  CapturedMessages captured;
  return read_material(inputs_of(texts), captured.messages, options);
}

const std::string demonstrations =
    "target,demo,t,x,y,z\n1,1,0,0,0,0\n1,1,1,0.1,0.2,0.3\n1,2,0,0,0,0\n1,2,1,0.1,0.2,0.5\n";
const std::string references =
    "target,t,x,y,z,start_x,start_y,start_z,goal_x,goal_y,goal_z\n1,0,0,0,0,0,0,0,1,2,3\n1,1,1,1,1,0,0,0,1,2,3\n";
const std::string motions = "target,t,x,y,z,sd_x,sd_y,sd_z\nn1,0,0,0,0,0,0,0\nn1,1,1,1,1,0.1,0.1,0.1\n";
const std::string weights = "target,signal,basis,mean,sd\nn1,x,1,5,1\nn1,x,2,-3,0.5\nn1,y,1,1,1\nn1,y,2,2,1\n";
const std::string errors =
    "target,method,rmse,end_error\n1,skill,0.01,0\n1,line,0.03,0\n2,skill,0.02,0\n2,line,0.05,0\n";
const std::string reliability = "method,nominal,pointwise,path,width\nskill,0.5,0.4,0.1,0.01\nskill,0.9,0.8,0.5,0.03\n";
const std::string scene =
    R"({"format":"lfdtools.scene","version":1,"obstacles":[{"type":"sphere","pose":{"position":[0,0,0]},"radius":0.1}]})";

}  // namespace

TEST_CASE("The content of a file says what it is") {
  const Material material = read({motions, demonstrations, references, "target,x,y,z\nn1,1,1,1\n"});
  REQUIRE(material.curves.size() == 4);
  CHECK(material.curves[0].role == Role::demonstration);
  CHECK(material.curves[2].role == Role::reference);
  CHECK(material.curves[2].goal->isApprox(Vector{{1, 2, 3}}));
  CHECK(material.curves[3].role == Role::motion);
  CHECK(material.curves[3].sd(1, 0) == 0.1);
  CHECK(material.goals.size() == 1);
  CHECK(material.found.size() == 4);
}

TEST_CASE("The picture follows from the content") {
  CHECK(suitable_kind(read({demonstrations})) == PictureKind::motions);
  CHECK(suitable_kind(read({demonstrations, scene})) == PictureKind::planes);
  CHECK(suitable_kind(read({scene})) == PictureKind::planes);
  CHECK(suitable_kind(read({"x,y,z\n1,2,3\n"})) == PictureKind::planes);
  CHECK(suitable_kind(read({"t,q1,q2,q3,q4,q5,q6\n0,0,0,0,0,0,0\n"})) == PictureKind::time);
  CHECK(suitable_kind(read({weights})) == PictureKind::weights);
  CHECK(suitable_kind(read({errors})) == PictureKind::errors);
  CHECK(suitable_kind(read({reliability})) == PictureKind::reliability);
}

TEST_CASE("Content for two pictures is refused, unless one is chosen") {
  const Material material = read({demonstrations, errors});
  CHECK(refusal_of([&] { (void)suitable_kind(material); }).id == "plot.several_pictures");
  CapturedMessages captured;
  CHECK(draw(material, {.kind = PictureKind::errors}, captured.messages).find("skill") != std::string::npos);
  CHECK(refusal_of([&] { (void)draw(material, {.kind = PictureKind::weights}, captured.messages); }).id ==
        "plot.nothing_to_draw");
}

TEST_CASE("What cannot be drawn is refused with a list of what can") {
  const Refusal refusal = refusal_of([] { (void)read({"demo_a,demo_b,cost\n1,2,0.5\n"}); });
  CHECK(refusal.fault == Fault::data);
  CHECK(refusal.id == "plot.unknown_content");
  CHECK(refusal.text.find("demo_a, demo_b, cost") != std::string::npos);
  CHECK(refusal.text.find("reliability") != std::string::npos);
  CHECK(refusal_of([] { (void)read({demonstrations, "t,u\n0,1\n"}); }).id == "plot.columns_differ");
  CHECK(refusal_of([] { (void)read({"method,nominal,pointwise,path,width\na,0.5,1.1,0,0\n"}); }).id == "plot.share");
  CHECK(refusal_of([] { (void)read({"signal,basis,mean,sd\nx,1,1,-1\n"}); }).id == "plot.negative_sd");
}

TEST_CASE("Goals may have other signals than x, y, z if the curves have them") {
  const Material material = read({"t,u,v\n0,1,2\n1,2,3\n", "target,u,v\na,2,3\n"});
  CHECK(material.signals == std::vector<std::string>{"u", "v"});
  CHECK(material.goals.size() == 1);
}

TEST_CASE("Measures of the errors are chosen by --columns") {
  MaterialOptions options;
  options.columns = {"rmse", "end_error"};
  const Material material = read({errors}, options);
  CHECK(material.errors[3].method == "line");
  CHECK(material.errors[3].values.isApprox(Vector{{0.05, 0}}));
}

TEST_CASE("Targets end at their goals, else at the mean of their last samples") {
  const CurveStyle measured(read({demonstrations}));
  REQUIRE(measured.ends().size() == 1);
  CHECK(measured.ends()[0].position.isApprox(Vector{{0.1, 0.2, 0.4}}));
  const CurveStyle told(read({demonstrations, references}));
  CHECK(told.ends()[0].position.isApprox(Vector{{1, 2, 3}}));
  CHECK(told.ends_name() == "goal");
}

TEST_CASE("The axis of bars ends at the largest value, or beyond the others where a few are far away") {
  CHECK(bar_limit({10, 20, 30}, {15, 25, 40}) == 40);
  CHECK(bar_limit({10, 20, 2000}, {15, 40, 5000}) == Approx(50));
  CHECK(bar_limit({0, 0}, {0, 0}) == 0);
  CHECK(bar_limit({}, {}) == 0);
}

TEST_CASE("Planes are pairs of signals") {
  CHECK(planes_of({"x-y", "q1-q2"}) == std::vector<Plane>{{"x", "y"}, {"q1", "q2"}});
  for (const char* word : {"x", "-x", "x-"}) CHECK(refusal_of([&] { (void)planes_of({word}); }).id == "usage.value");
  CapturedMessages captured;
  PictureOptions options;
  options.planes = {{"x", "w"}};
  CHECK(refusal_of([&] { (void)draw(read({demonstrations}), options, captured.messages); }).id ==
        "plot.no_such_signal");
}
