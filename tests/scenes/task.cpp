#include "task.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace lfd::scenes {
namespace {

Hole hole(const std::string& name, const Vector3& position) {
  return {name, position};
}

}  // namespace

Task draw_task(bool two_ways, Random random) {
  Task task;
  task.start = {random.uniform(-0.40, -0.25), random.uniform(0.40, 0.50), random.uniform(0.50, 0.75)};
  const Vector3 middle(random.uniform(-0.02, 0.12), random.uniform(0.74, 0.84), random.uniform(0.30, 0.50));
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      const Vector3 offset(0.15 * (column - 1), 0, 0.075 - 0.15 * row);
      task.holes.push_back(hole(std::to_string(3 * row + column + 1), middle + offset));
    }
  }
  for (int i = 0; i < 4; ++i) {
    const Vector3 offset(i % 2 == 0 ? -0.075 : 0.075, 0, i < 2 ? 0.035 : -0.035);
    task.new_holes.push_back(hole("n" + std::to_string(i + 1), middle + offset));
  }
  task.orientation << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // fixed-axis roll of -pi/2: z becomes +y

  const Vector3 along = (middle - task.start).normalized();
  const Vector3 side = along.cross(Vector3::UnitZ()).normalized();
  const Vector3 up = side.cross(along);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const Vector3 way = std::cos(angle) * side + std::sin(angle) * up;

  // Edges of the box across the straight way: `near` on the way's side, `far` on the other.
  const double near = random.uniform(0.02, 0.08);
  const double far = two_ways ? random.uniform(0.02, 0.08) : 0.25;
  const double thickness = random.uniform(0.02, 0.06);
  const double length = random.uniform(0.25, 0.5);
  Solid box;
  box.name = "box";
  box.shape = SolidShape::box;
  box.size = {thickness, near + far, length};
  box.pose.rotation << along, way, along.cross(way);
  box.pose.position = task.start + random.uniform(0.25, 0.5) * (middle - task.start) + (near - far) / 2 * way;
  task.obstacles.push_back(box);
  Solid table;
  table.name = "table";
  table.size = {4, 4, 1};
  table.pose.position = {0, 0, -0.5};
  task.ground.push_back(table);
  task.ways.push_back(way);
  if (two_ways) task.ways.push_back(-way);
  task.berth = std::max(near, two_ways ? far : 0.0);
  return task;
}

}  // namespace lfd::scenes
