// One scene of experiment B: a teacher who knows it demonstrates, every method learns from the demonstrations alone,
// and FCL judges what each does at the new holes. CSV on standard output, a row a motion:
//   scene,ways,method,target,outcome,reason,clearance,outside,hand_length,joint_length,jerk,seconds,probability
// (probability: of touching, told beforehand, where something is drawn) or, for a scene that the teacher cannot show or
// that asks for no detour, one row with the outcome set_aside.
//
//   scene-study one|two NUMBER [FOLDER]   a scene with one way round or two; FOLDER: the demonstrations (with joints),
//                                         the goals and the scene are left there as files
#include <fmt/format.h>

#include <cstdio>
#include <map>

#include "chances.hpp"
#include "lesson_files.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/methods.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/validation.hpp"
#include "planner.hpp"
#include "processor_time.hpp"
#include "studied_scene.hpp"

using namespace lfd;
using namespace lfd::scenes;

namespace {

/// The lesson of one scene, what is learnt from it, and what else is judged beside it.
class Study {
 public:
  Study(bool two_ways, int number, const Robot& robot)
      : random_(Random(two_ways ? 2 : 1).split(static_cast<std::uint64_t>(number))),
        scene_(two_ways, number, robot, random_.split(1)),
        task_(scene_.task()) {}

  void run(const std::string& folder) {
    if (const std::string reason = scene_.plan_lesson(); !reason.empty()) return scene_.set_aside(reason);
    int blocked = 0;
    for (const Hole& hole : task_.new_holes) {
      const auto least = scene_.teacher().clearance(straight_line(task_.start, hole.position, linspace(0, 1, 101)),
                                                    scene_.lesson().branch);
      blocked += !least || *least < 0 ? 1 : 0;
    }
    if (blocked < 3) return scene_.set_aside("straight_way_clear");
    for (std::size_t i = 0; i < task_.holes.size(); ++i) {
      auto shown =
          demonstrate(scene_.teacher(), scene_.lesson().meant[i], scene_.lesson().branch, random_.split(2).split(i));
      if (shown.size() < repetitions) return scene_.set_aside("noise_collides");
      targets_.push_back({{task_.holes[i].target, {}, {}, {}}, std::move(shown)});
    }
    if (!folder.empty()) write_lesson(folder, task_, scene_.teacher(), scene_.lesson().branch, targets_);
    judge_methods();
    std::vector<SkillRow> rows;
    for (const auto& target : training_) {
      for (const auto& example : target.examples) rows.push_back({target.labels, example.primitive});
    }
    const BandedSkill banded(std::move(rows));
    judge_chances(scene_, banded, skill_, skill_paths_, random_.split(3));
    judge_parted(banded);
    judge_controls();
    judge_planners();
  }

 private:
  void judge_path(const std::string& method, const Hole& hole, const Samples& path, double taken,
                  const FclScene& scene) {
    const Verdict verdict = judge(scene_.arm(), scene, task_.orientation, path, scene_.joints_at(task_.start),
                                  scene_.lesson().branch, seconds);
    scene_.row(method, hole.target, verdict, path.allFinite() ? outside_depth(path, query(hole), judged()) : 0.0,
               taken);
  }

  [[nodiscard]] Query query(const Hole& hole) const { return {task_.start, hole.position, 1, {}}; }

  [[nodiscard]] std::vector<const JudgedTarget*> judged() const {
    std::vector<const JudgedTarget*> pointers;
    for (const auto& target : judged_) pointers.push_back(&target);
    return pointers;
  }

  void judge_methods() {
    const PreparationOptions preparation;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      judged_.push_back(judged_target(targets_[i].labels, targets_[i].demonstrations));
      training_.push_back(
          training_target(targets_[i].labels, targets_[i].demonstrations, preparation, {true, true}, i));
    }
    Fold fold;
    for (const auto& target : training_) fold.push_back(&target);
    for (const Method& method : methods()) {
      if (!method.same_as.empty()) continue;
      const double begin = processor_time();
      const Predictor predictor = method.train(fold, preparation);
      const double learnt = processor_time() - begin;
      for (const Hole& hole : task_.new_holes) {
        const double asked = processor_time();
        const Samples path = predictor(query(hole)).path;
        judge_path(method.name, hole, path, learnt + processor_time() - asked, scene_.fcl());
        if (method.name == "skill") skill_paths_.push_back(path);
      }
      if (method.name == "skill") skill_ = predictor;
    }
  }

  /// The opponents, learnt of each way by itself, as the default skill does: what is then left is the learning.
  void judge_parted(const BandedSkill& banded) {
    if (!banded.ways()) return;
    const PreparationOptions preparation;
    std::vector<TrainingTarget> parted[2];
    std::size_t row = 0;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      std::vector<Trajectory> of_way[2];
      for (const auto& shown : targets_[i].demonstrations) of_way[banded.ways()->of_row[row++]].push_back(shown);
      for (const int way : {0, 1}) {
        if (of_way[way].empty()) continue;
        parted[way].push_back(training_target(targets_[i].labels, of_way[way], preparation, {true, true}, i));
      }
    }
    for (const Method& method : methods()) {
      if (!method.same_as.empty() || method.name.starts_with("skill") || method.name == "line") continue;
      std::vector<Predictor> predictors;
      for (const auto& targets : parted) {
        Fold fold;
        for (const auto& target : targets) fold.push_back(&target);
        if (fold.size() >= 2) predictors.push_back(method.train(fold, preparation));
      }
      if (predictors.size() < 2) continue;
      for (const Hole& hole : task_.new_holes) {
        const std::size_t way = banded.way_to(hole.position - task_.start);
        judge_path(method.name + "+ways", hole, predictors[way](query(hole)).path, 0, scene_.fcl());
      }
    }
  }

  /// What is not learnt from the demonstrations of this scene, or not judged in it.
  void judge_controls() {
    // The demonstration that goes furthest from the straight way, moved to each new hole.
    const Samples* furthest = nullptr;
    for (const auto& target : judged_) {
      for (const auto& deviation : target.deviations) {
        const auto depth = [](const Samples& d) { return d.rowwise().norm().maxCoeff(); };
        if (furthest == nullptr || depth(deviation) > depth(*furthest)) furthest = &deviation;
      }
    }
    const Vector phases = linspace(0, 1, phase_count);
    for (const Hole& hole : task_.new_holes) {
      judge_path("largest-detour", hole, straight_line(task_.start, hole.position, phases) + *furthest, 0,
                 scene_.fcl());
    }
    for (std::size_t i = 0; i < task_.new_holes.size(); ++i) {
      const auto& meant = scene_.lesson().of_new_holes[i].front();
      if (meant) {
        judge_path("teacher", task_.new_holes[i], meant->positions(phases), 0, scene_.fcl());
      } else {
        Verdict none;
        none.reason = "no_way_round";
        scene_.row("teacher", task_.new_holes[i].target, none, 0, 0);
      }
    }
    // A's skill: the same hand, taught where there is no obstacle.
    std::vector<TrainingTarget> free;
    for (std::size_t i = 0; i < task_.holes.size(); ++i) {
      std::vector<Trajectory> shown;
      for (std::uint64_t k = 0; k < repetitions; ++k) {
        shown.push_back(perform([&](const Vector& s) { return straight_line(task_.start, task_.holes[i].position, s); },
                                seconds, 100, TeacherNoise(), random_.split(2).split(i).split(k)));
      }
      free.push_back(training_target(targets_[i].labels, shown, {}, {true, false}, i));
    }
    Fold fold;
    for (const auto& target : free) fold.push_back(&target);
    const Predictor of_a = chosen_methods({"skill"}).front()->train(fold, {});
    for (const Hole& hole : task_.new_holes) judge_path("skill-of-A", hole, of_a(query(hole)).path, 0, scene_.fcl());
    // The obstacle moved after teaching, to where the hand now goes.
    std::vector<Solid> moved = task_.obstacles;
    for (auto& solid : moved) solid.pose.position += (task_.berth + margin) * task_.ways.front();
    const FclScene elsewhere(scene_.arm().robot(), moved, task_.ground);
    for (std::size_t i = 0; i < task_.new_holes.size(); ++i) {
      judge_path("skill-obstacle-moved", task_.new_holes[i], skill_paths_[i], 0, elsewhere);
    }
  }

  /// Planners that know the scene, by the very distances of FCL.
  void judge_planners() {
    const Joints start = scene_.joints_at(task_.start);
    const auto free = [&](const Joints& q) { return scene_.fcl().distance(q) > 0; };
    const std::map<std::string, Planner> planners = {{"rrt-connect", Planner::rrt_connect}, {"prm", Planner::prm}};
    for (const auto& [name, planner] : planners) {
      for (std::size_t i = 0; i < task_.new_holes.size(); ++i) {
        Joints goal = scene_.joints_at(task_.new_holes[i].position);
        for (int j = 0; j < 6; ++j) goal[j] = start[j] + wrap_angle(goal[j] - start[j]);
        Verdict verdict;
        const auto path = plan_joints(planner, start, goal, free);
        if (!path) {
          verdict.reason = "no_path";
          scene_.row(name, task_.new_holes[i].target, verdict, 0, 0);
          continue;
        }
        Samples hand(path->joints.rows(), 3);
        for (Eigen::Index t = 0; t < hand.rows(); ++t) {
          hand.row(t) = forward_kinematics(scene_.arm().robot(), path->joints.row(t).transpose()).position.transpose();
        }
        verdict.hand_length = path_length(hand);
        verdict.joint_length = path_length(path->joints);
        verdict.clearance = least_distance(scene_.fcl(), path->joints);
        verdict.outcome = verdict.clearance > 0 ? Outcome::clear : Outcome::collided;
        scene_.row(name, task_.new_holes[i].target, verdict, 0, path->seconds);
      }
    }
  }

  Random random_;
  StudiedScene scene_;
  const Task& task_;  // the scene's
  std::vector<TargetDemonstrations> targets_;
  std::vector<JudgedTarget> judged_;
  std::vector<TrainingTarget> training_;
  std::vector<Samples> skill_paths_;
  Predictor skill_;  // the default one
};

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (argc < 3 || argc > 4 || (kind != "one" && kind != "two")) {
    fmt::print(stderr, "usage: scene-study one|two NUMBER [FOLDER]\n");
    return 64;
  }
  const int number = std::stoi(argv[2]);
  seed_planners(static_cast<unsigned>(number + 1));
  Messages messages("scene-study");
  Study(kind == "two", number, load_robot(find_data_file("ur10", "robots"), messages)).run(argc == 4 ? argv[3] : "");
  return 0;
}
