// One scene of experiment B: a teacher who knows it demonstrates, every method learns from the demonstrations alone,
// and FCL judges what each does at the new holes. CSV on standard output, a row a motion:
//   scene,ways,method,target,outcome,reason,clearance,outside,hand_length,joint_length,jerk,seconds,probability
// (probability: of touching, as the default skill's calibrated latent covariance has it through the arm's Jacobian) or,
// for a scene that the teacher cannot show or that asks for no detour, one row with the outcome set_aside.
//
//   scene-study one|two NUMBER [FOLDER]   a scene with one way round or two; FOLDER: the demonstrations (with joints),
//                                         the goals and the scene are left there as files
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>

#include "lesson.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/methods.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/posterior.hpp"
#include "lfdtools/touching.hpp"
#include "lfdtools/validation.hpp"
#include "lfdtools/ways.hpp"
#include "planner.hpp"
#include "verdict.hpp"

using namespace lfd;
using namespace lfd::scenes;

namespace {

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Study {
 public:
  Study(bool two_ways, int number, const Robot& robot)
      : number_(number),
        random_(Random(two_ways ? 2 : 1).split(static_cast<std::uint64_t>(number))),
        task_(draw_task(two_ways, random_.split(1))),
        teacher_(robot, task_, margin),
        fcl_(robot, task_.obstacles, task_.ground) {}

  void run(const std::string& folder) {
    if (const std::string reason = teach(teacher_, task_, lesson_); !reason.empty()) return set_aside(reason);
    int blocked = 0;
    for (const Hole& hole : task_.new_holes) {
      const auto least =
          teacher_.clearance(straight_line(task_.start, hole.position, linspace(0, 1, 101)), lesson_.branch);
      blocked += !least || *least < 0 ? 1 : 0;
    }
    if (blocked < 3) return set_aside("straight_way_clear");
    for (std::size_t i = 0; i < task_.holes.size(); ++i) {
      auto shown = demonstrate(teacher_, lesson_.meant[i], lesson_.branch, random_.split(2).split(i));
      if (shown.size() < repetitions) return set_aside("noise_collides");
      targets_.push_back({{task_.holes[i].target, {}, {}, {}}, std::move(shown)});
    }
    if (!folder.empty()) write(folder);
    judge_methods();
    judge_parted();
    judge_controls();
    judge_planners();
  }

 private:
  void set_aside(const std::string& reason) const {
    fmt::print("{},{},,,set_aside,{},,,,,,,\n", number_, task_.ways.size(), reason);
  }

  void row(const std::string& method, const std::string& target, const Verdict& verdict, double outside, double taken,
           const std::string& probability = "") const {
    const char* words[] = {"clear", "collided", "refused"};
    fmt::print("{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.3f},{:.3f},{:.6f},{}\n", number_, task_.ways.size(), method,
               target, words[static_cast<int>(verdict.outcome)], verdict.reason, verdict.clearance, outside,
               verdict.hand_length, verdict.joint_length, verdict.jerk, taken, probability);
  }

  void judge_path(const std::string& method, const Hole& hole, const Samples& path, double taken,
                  const FclScene& scene) {
    const Verdict verdict =
        judge(teacher_.arm(), scene, task_.orientation, path, start_joints(), lesson_.branch, seconds);
    std::string probability;
    if (method == "skill" && verdict.outcome != Outcome::refused) {
      probability = fmt::format("{:.5f}", chance_of_touching(hole, path));
    }
    row(method, hole.target, verdict, path.allFinite() ? outside_depth(path, query(hole), judged()) : 0.0, taken,
        probability);
  }

  [[nodiscard]] Joints start_joints() const {
    Samples start(1, 3);
    start.row(0) = task_.start.transpose();
    return joints_along(teacher_.arm(), task_.orientation, lesson_.branch, start)->row(0).transpose();
  }

  [[nodiscard]] Query query(const Hole& hole) const { return {task_.start, hole.position, 1, {}}; }

  [[nodiscard]] std::vector<const JudgedTarget*> judged() const {
    std::vector<const JudgedTarget*> pointers;
    for (const auto& target : judged_) pointers.push_back(&target);
    return pointers;
  }

  /// The default skill, learnt once more for its covariance; one a way round.
  void learn_covariance() {
    for (const auto& target : training_) {
      for (const auto& example : target.examples) rows_.push_back({target.labels, example.primitive});
    }
    const std::vector<std::string> xyz = {"x", "y", "z"};
    SkillOptions options;
    options.kernel = choose_kernel(xyz, rows_, options);
    const Skill together = train_skill(xyz, rows_, options);
    ways_ = two_ways(together, rows_);
    for (const int way : {0, 1}) {
      if (!ways_ && way == 1) break;
      const auto of_way = ways_ ? rows_of_way(rows_, *ways_, way) : rows_;
      Skill skill = ways_ ? train_skill(xyz, of_way, options) : together;
      skill.calibration = calibrate(skill, of_way, options);
      predictors_.emplace_back(std::move(skill));
    }
  }

  [[nodiscard]] double chance_of_touching(const Hole& hole, const Samples& path) {
    if (predictors_.empty()) learn_covariance();
    const Vector change = hole.position - task_.start;
    const SkillPredictor& predictor =
        predictors_.at(ways_ ? static_cast<std::size_t>(nearest_way(rows_, *ways_, change)) : 0);
    const MotionPosterior posterior = predict_motion(predictor, {{}, hole.position, Vector(task_.start), seconds});
    constexpr Eigen::Index every = 5;
    const Eigen::Index n = (path.rows() + every - 1) / every;
    Samples sparse(n, 3);
    Vector times(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      sparse.row(k) = path.row(k * every);
      times[k] = seconds * static_cast<double>(k * every) / static_cast<double>(path.rows() - 1);
    }
    std::vector<Matrix> covariance = motion_covariance(posterior, times, Spread::latent);
    const Vector factors = covariance_factors(predictor, Reach(change, Vector(task_.start) - predictor.skill().start));
    for (std::size_t j = 0; j < covariance.size() && factors.size() > 0; ++j) {
      covariance[j] *= factors[static_cast<Eigen::Index>(j)];
    }
    const auto joints = joints_along(teacher_.arm(), task_.orientation, lesson_.branch, sparse);
    const ArmClearance bodies(teacher_.arm().robot(), task_.obstacles);
    return touching(bodies, *joints, hand_spread(covariance, Matrix3::Identity())).path.probability;
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
        judge_path(method.name, hole, path, learnt + processor_time() - asked, fcl_);
        if (method.name == "skill") skill_paths_.push_back(path);
      }
    }
  }

  /// The opponents, learnt of each way by itself, as the default skill does: what is then left is the learning.
  void judge_parted() {
    if (!ways_) return;
    const PreparationOptions preparation;
    std::vector<TrainingTarget> parted[2];
    std::size_t row = 0;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      std::vector<Trajectory> of_way[2];
      for (const auto& shown : targets_[i].demonstrations) of_way[ways_->of_row[row++]].push_back(shown);
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
        const auto way = static_cast<std::size_t>(nearest_way(rows_, *ways_, hole.position - task_.start));
        judge_path(method.name + "+ways", hole, predictors[way](query(hole)).path, 0, fcl_);
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
      judge_path("largest-detour", hole, straight_line(task_.start, hole.position, phases) + *furthest, 0, fcl_);
    }
    for (std::size_t i = 0; i < task_.new_holes.size(); ++i) {
      const auto& meant = lesson_.of_new_holes[i].front();
      if (meant) {
        judge_path("teacher", task_.new_holes[i], meant->positions(phases), 0, fcl_);
      } else {
        Verdict none;
        none.reason = "no_way_round";
        row("teacher", task_.new_holes[i].target, none, 0, 0);
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
    for (const Hole& hole : task_.new_holes) judge_path("skill-of-A", hole, of_a(query(hole)).path, 0, fcl_);
    // The obstacle moved after teaching, to where the hand now goes.
    std::vector<Solid> moved = task_.obstacles;
    for (auto& solid : moved) solid.pose.position += (task_.berth + margin) * task_.ways.front();
    const FclScene elsewhere(teacher_.arm().robot(), moved, task_.ground);
    for (std::size_t i = 0; i < task_.new_holes.size(); ++i) {
      judge_path("skill-obstacle-moved", task_.new_holes[i], skill_paths_[i], 0, elsewhere);
    }
  }

  /// Planners that know the scene, by the very distances of FCL.
  void judge_planners() {
    const Joints start = start_joints();
    const auto free = [&](const Joints& q) { return fcl_.distance(q) > 0; };
    const std::map<std::string, Planner> planners = {{"rrt-connect", Planner::rrt_connect}, {"prm", Planner::prm}};
    for (const auto& [name, planner] : planners) {
      for (std::size_t i = 0; i < task_.new_holes.size(); ++i) {
        Samples end(1, 3);
        end.row(0) = task_.new_holes[i].position.transpose();
        Joints goal = joints_along(teacher_.arm(), task_.orientation, lesson_.branch, end)->row(0).transpose();
        for (int j = 0; j < 6; ++j) goal[j] = start[j] + wrap_angle(goal[j] - start[j]);
        Verdict verdict;
        const auto path = plan_joints(planner, start, goal, free);
        if (!path) {
          verdict.reason = "no_path";
          row(name, task_.new_holes[i].target, verdict, 0, 0);
          continue;
        }
        Samples hand(path->joints.rows(), 3);
        for (Eigen::Index t = 0; t < hand.rows(); ++t) {
          hand.row(t) =
              forward_kinematics(teacher_.arm().robot(), path->joints.row(t).transpose()).position.transpose();
        }
        verdict.hand_length = path_length(hand);
        verdict.joint_length = path_length(path->joints);
        verdict.clearance = least_distance(fcl_, path->joints);
        verdict.outcome = verdict.clearance > 0 ? Outcome::clear : Outcome::collided;
        row(name, task_.new_holes[i].target, verdict, 0, path->seconds);
      }
    }
  }

  void write(const std::string& folder) const {
    std::ofstream demos(folder + "/demos.csv");
    demos << "target,demo,t,x,y,z,q1,q2,q3,q4,q5,q6\n";
    for (const auto& target : targets_) {
      for (std::size_t k = 0; k < target.demonstrations.size(); ++k) {
        const Trajectory& shown = target.demonstrations[k];
        const auto joints = joints_along(teacher_.arm(), task_.orientation, lesson_.branch, shown.positions);
        for (Eigen::Index t = 0; t < shown.samples(); ++t) {
          demos << fmt::format("{},{},{},{},{},{}", *target.labels.target, k + 1, shown.times[t], shown.positions(t, 0),
                               shown.positions(t, 1), shown.positions(t, 2));
          for (int j = 0; j < 6; ++j) demos << fmt::format(",{}", (*joints)(t, j));
          demos << '\n';
        }
      }
    }
    std::ofstream goals(folder + "/goals.csv");
    goals << "target,x,y,z\n";
    for (const auto& hole : task_.new_holes) {
      goals << fmt::format("{},{},{},{}\n", hole.target, hole.position[0], hole.position[1], hole.position[2]);
    }
    std::ofstream scene(folder + "/scene.json");
    scene << R"({"format":"lfdtools.scene","version":1,"frame":"base","obstacles":[)";
    std::vector<Solid> solids = task_.obstacles;
    solids.insert(solids.end(), task_.ground.begin(), task_.ground.end());
    for (std::size_t i = 0; i < solids.size(); ++i) {
      const Solid& box = solids[i];
      const Quaternion q = quaternion_from_rotation(box.pose.rotation);
      scene << fmt::format(
          R"({}{{"name":"{}","type":"box","pose":{{"position":[{},{},{}],"orientation":[{},{},{},{}]}},"size":[{},{},{}]}})",
          i > 0 ? "," : "", box.name, box.pose.position[0], box.pose.position[1], box.pose.position[2], q[0], q[1],
          q[2], q[3], box.size[0], box.size[1], box.size[2]);
    }
    scene << "]}\n";
  }

  int number_;
  Random random_;
  Task task_;
  Teacher teacher_;
  FclScene fcl_;
  Lesson lesson_;
  std::vector<TargetDemonstrations> targets_;
  std::vector<JudgedTarget> judged_;
  std::vector<TrainingTarget> training_;
  std::vector<Samples> skill_paths_;
  std::vector<SkillRow> rows_;
  std::optional<Ways> ways_;
  std::vector<SkillPredictor> predictors_;  // of the default skill, by way
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
