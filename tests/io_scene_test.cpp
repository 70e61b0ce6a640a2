#include <catch2/catch.hpp>

#include "io_fixture.hpp"
#include "lfdtools/io/scene_file.hpp"

using namespace lfd;

namespace {

Scene read(const std::string& text) {
  CapturedMessages captured;
  return read_scene(JsonDocument(text, "scene.json", captured.messages));
}

std::string scene(const std::string& obstacle, const std::string& frame = "base") {
  return R"({"format":"lfdtools.scene","version":1,"frame":")" + frame + R"(","obstacles":[)" + obstacle + "]}";
}

const std::string box =
    R"({"name":"wall","type":"box","pose":{"position":[1,2,3],"orientation":[0,0,0,1]},"size":[0.1,0.2,0.3]})";

}  // namespace

TEST_CASE("A scene has its obstacles, with their sizes") {
  const Scene read_back =
      read(scene(box + R"(,{"type":"capsule","pose":{"position":[0,0,0]},"radius":0.1,"length":2})"));
  REQUIRE(read_back.obstacles.size() == 2);
  CHECK(read_back.obstacles[0].name == "wall");
  CHECK(read_back.obstacles[0].size.isApprox(Vector3(0.1, 0.2, 0.3)));
  CHECK(read_back.obstacles[0].pose.rotation(0, 0) == Approx(-1));
  CHECK(read_back.obstacles[1].shape == SolidShape::capsule);
  CHECK(read_back.obstacles[1].length == 2);
}

TEST_CASE("base_link is turned by pi about z") {
  const auto solids = read(scene(box, "base_link")).in_base();
  CHECK(solids[0].pose.position.isApprox(Vector3(-1, -2, 3)));
  CHECK(solids[0].pose.rotation.isApprox(Matrix3::Identity()));
  CHECK(read(scene(box)).in_base()[0].pose.position.isApprox(Vector3(1, 2, 3)));
  Robot raised;
  raised.frames["base_link"] = {Matrix3::Identity(), {0, 0, 0.5}};
  raised.frames["base"] = {Matrix3::Identity(), {0.1, 0, 0}};
  CHECK(read(scene(box, "base_link")).in_base(raised)[0].pose.position.isApprox(Vector3(1, 2, 3.5)));
  CHECK(read(scene(box)).in_base(raised)[0].pose.position.isApprox(Vector3(1.1, 2, 3)));
}

TEST_CASE("What a scene cannot mean is refused with its place") {
  CHECK(refusal_of([] { (void)read(scene(box, "world")); }).id == "scene.frame");
  const Refusal type = refusal_of([] { (void)read(scene(R"({"type":"cone","pose":{"position":[0,0,0]}})")); });
  CHECK(type.id == "scene.type");
  CHECK(type.place.pointer == "/obstacles/0/type");
  CHECK(refusal_of([] { (void)read(scene(R"({"type":"sphere","pose":{"position":[0,0,0]},"radius":0})")); }).id ==
        "json.out_of_range");
  CHECK(refusal_of([] { (void)read(scene(R"({"type":"box","pose":{"position":[0,0,0]}})")); }).id ==
        "json.missing_key");
  CHECK(refusal_of([] {
          (void)read(scene(R"({"type":"plane","pose":{"position":[0,0,0],"orientation":[1,1,0,0]}})"));
        }).id == "rotation.not_unit");
}

TEST_CASE("A scene is loaded by path, and its faults are status 78") {
  const ScratchFolder folder;
  CapturedMessages captured;
  CHECK(load_scene(folder.write("cell.json", scene(box)), captured.messages).obstacles.size() == 1);
  const std::string bad = folder.write("bad.json", scene(R"({"type":"cone","pose":{"position":[0,0,0]}})"));
  CHECK(refusal_of([&] { (void)load_scene(bad, captured.messages); }).fault == Fault::config);
  CHECK(refusal_of([&] { (void)load_scene(folder.file("none.json"), captured.messages); }).fault == Fault::no_input);
}
