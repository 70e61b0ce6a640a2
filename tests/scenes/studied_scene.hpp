// One scene of the study: its task, its teacher, its bodies for the verdict, and the rows that tell of motions in it.
#pragma once

#include <optional>
#include <string>

#include "lesson.hpp"
#include "verdict.hpp"

namespace lfd::scenes {

class StudiedScene {
 public:
  /// @param random  what the task is drawn by
  StudiedScene(bool two_ways, int number, const Robot& robot, const Random& random);
  StudiedScene(const StudiedScene&) = delete;  // the teacher looks at the task
  StudiedScene& operator=(const StudiedScene&) = delete;

  [[nodiscard]] const Task& task() const { return task_; }
  [[nodiscard]] const Teacher& teacher() const { return teacher_; }
  [[nodiscard]] const InverseKinematics& arm() const { return teacher_.arm(); }
  [[nodiscard]] const FclScene& fcl() const { return fcl_; }

  /// Plans the lesson. @return a reason why there is none, or nothing
  [[nodiscard]] std::string plan_lesson() { return teach(teacher_, task_, lesson_); }
  [[nodiscard]] const Lesson& lesson() const { return lesson_; }

  /// Joints along a hand path in the lesson's branch, n x 6 [rad]; empty where it is out of the branch's reach.
  /// @param path  n x 3, in the base [m]
  [[nodiscard]] std::optional<Samples> joints_of(const Samples& path) const;
  /// Joints at one position of the hand, which is in reach [rad].
  [[nodiscard]] Joints joints_at(const Vector3& position) const;

  /// Writes the only row of a scene that is not studied.
  void set_aside(const std::string& reason) const;

  /// Writes the row of a motion. @param outside  the demonstrated [m]   @param taken  processor time [s]
  /// @param probability  of touching, where it was told beforehand
  void row(const std::string& method, const std::string& target, const Verdict& verdict, double outside, double taken,
           const std::string& probability = "") const;

 private:
  int number_;
  Task task_;
  Teacher teacher_;
  FclScene fcl_;
  Lesson lesson_;
};

}  // namespace lfd::scenes
