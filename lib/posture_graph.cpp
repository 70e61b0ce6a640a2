#include "lfdtools/posture_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "posture_turns.hpp"

namespace lfd {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Turns further out are not counted: they have no digits left for the angle.
constexpr double most_turns = 1e9;

/// A posture with the whole turns that each joint may have; a state is a posture and one value of each, numbered in
/// mixed radix. A joint whose turns are not counted has one.
struct Node {
  std::array<int, 6> low{};
  std::array<int, 6> count{1, 1, 1, 1, 1, 1};
  std::size_t first = 0;
  std::size_t states = 1;
};

class Graph {
 public:
  Graph(const Layers& layers, const Vector& times, const JointLimits& limits, const GraphOptions& options)
      : layers_(layers), limits_(limits), options_(options) {
    edges_.resize(layers.size());
    for (std::size_t t = 1; t < layers.size(); ++t) {
      const double dt = times[static_cast<Eigen::Index>(t)] - times[static_cast<Eigen::Index>(t) - 1];
      edges_[t].reserve(layers[t - 1].size() * layers[t].size());
      for (const Posture& from : layers[t - 1]) {
        for (const Posture& to : layers[t]) edges_[t].push_back(edge(from, to, dt));
      }
    }
  }

  /// The best way through, ranges left aside until the end, and there is no answer if the way leaves them.
  [[nodiscard]] std::optional<Way> solve() {
    counted_.fill(false);
    jumping_ = true;
    return best();
  }

  /// The best way within the ranges, whole turns being states of their own. Ways without jumps come first and turn far
  /// less, so without `jumping` only they are looked at.
  [[nodiscard]] std::optional<Way> solve_counting(bool jumping) {
    jumping_ = jumping;
    const TurnWindow window = turn_window(layers_, edges_, limits_.position, options_.seed, jumping_);
    counted_ = window.counted;
    range_ = window.range;
    return best();
  }

  /// First layer that no way within the limits comes to, after solve_counting(true) has failed.
  [[nodiscard]] Eigen::Index blocked() const {
    std::vector<char> reached(states_[0], 1);
    std::size_t t = 0;
    while (std::find(reached.begin(), reached.end(), 1) != reached.end() && ++t < layers_.size()) {
      std::vector<char> next(states_[t], 0);
      for_each_edge(t, [&](std::size_t from, std::size_t to, const Edge&) { next[to] |= reached[from]; });
      reached = std::move(next);
    }
    return static_cast<Eigen::Index>(t);
  }

 private:
  struct Starts {
    std::vector<std::size_t> states;
    double largest_ratio = 0.0;  // allowed along the way
  };

  /// In the order of the criteria.
  struct Cost {
    int jumps = std::numeric_limits<int>::max();
    int changes = 0;
    double seconds = 0.0;
    double start = 0.0;
    bool operator<(const Cost& other) const {
      return std::tie(jumps, changes, seconds, start) <
             std::tie(other.jumps, other.changes, other.seconds, other.start);
    }
    [[nodiscard]] bool reached() const { return jumps < std::numeric_limits<int>::max(); }
  };

  [[nodiscard]] Edge edge(const Posture& from, const Posture& to, double dt) const {
    Edge e;
    double largest = 0.0;
    for (int j = 0; j < 6; ++j) {
      const double n = std::nearbyint((from.joints[j] - to.joints[j]) / turn);
      const double step = std::abs(to.joints[j] + turn * n - from.joints[j]);
      e.turns[static_cast<std::size_t>(j)] = static_cast<int>(n);
      e.seconds = std::max(e.seconds, step / limits_.velocity[j]);
      largest = std::max(largest, step);
    }
    e.ratio = e.seconds / dt + (largest > options_.max_step ? jump_cost : 0.0);
    e.changes_branch = ((from.branch ^ to.branch) & ~(from.border | to.border)) != 0;
    return e;
  }

  [[nodiscard]] std::optional<Way> best() {
    number_states();
    const Starts starts = choose_starts(bottlenecks());
    return starts.states.empty() ? std::nullopt : trace(starts);
  }

  void number_states() {
    nodes_.assign(layers_.size(), {});
    states_.assign(layers_.size(), 0);
    for (std::size_t t = 0; t < layers_.size(); ++t) {
      for (const Posture& posture : layers_[t]) {
        Node node;
        node.first = states_[t];
        for (std::size_t j = 0; j < 6; ++j) {
          if (!counted_[j]) continue;
          const auto row = static_cast<Eigen::Index>(j);
          const double low = std::ceil((range_(row, 0) - posture.joints[row]) / turn);
          const double high = std::floor((range_(row, 1) - posture.joints[row]) / turn);
          node.low[j] = static_cast<int>(std::clamp(low, -most_turns, most_turns));
          node.count[j] =
              std::abs(low) > most_turns ? 0 : static_cast<int>(std::clamp(high - low + 1.0, 0.0, most_turns));
          node.states *= static_cast<std::size_t>(node.count[j]);
        }
        states_[t] += node.states;
        nodes_[t].push_back(node);
      }
    }
  }

  [[nodiscard]] static std::array<int, 6> turns_of(const Node& node, std::size_t state) {
    std::array<int, 6> turns = node.low;
    for (std::size_t j = 0; j < 6; ++j) {
      const auto count = static_cast<std::size_t>(node.count[j]);
      turns[j] += static_cast<int>(state % count);
      state /= count;
    }
    return turns;
  }

  /// visit(state of layer t - 1, state of layer t, edge) for every edge between them, the first state rising.
  template <class Visit>
  void for_each_edge(std::size_t t, Visit visit) const {
    for (std::size_t i = 0; i < nodes_[t - 1].size(); ++i) {
      const Node& from = nodes_[t - 1][i];
      for (std::size_t state = 0; state < from.states; ++state) {
        const auto turns = turns_of(from, state);
        for (std::size_t k = 0; k < nodes_[t].size(); ++k) {
          const Edge& e = edges_[t][i * nodes_[t].size() + k];
          if (e.jumps() && !jumping_) continue;
          if (const auto number = state_after(turns, e, nodes_[t][k])) visit(from.first + state, *number, e);
        }
      }
    }
  }

  [[nodiscard]] std::optional<std::size_t> state_after(const std::array<int, 6>& turns, const Edge& e,
                                                       const Node& to) const {
    int number = 0, radix = 1;
    for (std::size_t j = 0; j < 6; ++j) {
      if (!counted_[j]) continue;
      const int digit = turns[j] + e.turns[j] - to.low[j];
      if (digit < 0 || digit >= to.count[j]) return std::nullopt;
      number += radix * digit;
      radix *= to.count[j];
    }
    return to.first + static_cast<std::size_t>(number);
  }

  /// For every state of the first layer the largest ratio of the way from it whose largest ratio is smallest.
  [[nodiscard]] std::vector<double> bottlenecks() const {
    std::vector<double> ahead(states_.back(), 0.0);
    for (std::size_t t = layers_.size() - 1; t > 0; --t) {
      std::vector<double> before(states_[t - 1], infinity);
      for_each_edge(t, [&](std::size_t from, std::size_t to, const Edge& e) {
        before[from] = std::min(before[from], std::max(e.ratio, ahead[to]));
      });
      ahead = std::move(before);
    }
    return ahead;
  }

  [[nodiscard]] std::size_t posture_of(std::size_t t, std::size_t state) const {
    std::size_t i = 0;
    while (state >= nodes_[t][i].first + nodes_[t][i].states) ++i;
    return i;
  }

  [[nodiscard]] Joints start_joints(std::size_t state) const {
    const std::size_t i = posture_of(0, state);
    Joints q = layers_[0][i].joints;
    const auto turns = turns_of(nodes_[0][i], state - nodes_[0][i].first);
    for (int j = 0; j < 6; ++j) {
      if (counted_[static_cast<std::size_t>(j)]) {
        q[j] += turn * turns[static_cast<std::size_t>(j)];
      } else if (options_.seed) {
        q[j] += turn * std::nearbyint(((*options_.seed)[j] - q[j]) / turn);
      }
    }
    return q;
  }

  [[nodiscard]] Starts choose_starts(const std::vector<double>& ahead) const {
    Starts starts;
    const double best = ahead.empty() ? infinity : *std::min_element(ahead.begin(), ahead.end());
    if (best == infinity) return starts;
    double bottleneck = best;
    if (options_.seed) {
      // A way that has to jump anyhow is no reason to leave the seed, but only its best starts count then.
      const double admitted = best < jump_cost ? std::nextafter(jump_cost, 0.0) : with_slack(best);
      double nearest = infinity;
      for (std::size_t s = 0; s < ahead.size(); ++s) {
        if (ahead[s] > admitted) continue;
        const double apart = (start_joints(s) - *options_.seed).cwiseQuotient(limits_.velocity).squaredNorm();
        if (!(apart < nearest)) continue;
        nearest = apart;
        starts.states = {s};
        bottleneck = ahead[s];
      }
    }
    starts.largest_ratio = with_slack(bottleneck);
    for (std::size_t s = 0; !options_.seed && s < ahead.size(); ++s) {
      if (ahead[s] <= starts.largest_ratio) starts.states.push_back(s);
    }
    return starts;
  }

  [[nodiscard]] double with_slack(double ratio) const {
    const double base = ratio < jump_cost ? 0.0 : jump_cost;
    return base + (ratio - base) * options_.step_slack;
  }

  [[nodiscard]] std::optional<Way> trace(const Starts& starts) const {
    const std::size_t T = layers_.size();
    std::vector<Cost> cost(states_[0]);
    for (const std::size_t s : starts.states) cost[s] = {0, 0, 0.0, start_joints(s).squaredNorm()};
    std::vector<std::vector<std::size_t>> previous(T);
    for (std::size_t t = 1; t < T; ++t) {
      std::vector<Cost> next(states_[t]);
      previous[t].assign(states_[t], 0);
      for_each_edge(t, [&](std::size_t from, std::size_t to, const Edge& e) {
        if (!cost[from].reached() || e.ratio > starts.largest_ratio) return;
        const Cost sum{cost[from].jumps + (e.jumps() ? 1 : 0), cost[from].changes + (e.changes_branch ? 1 : 0),
                       cost[from].seconds + e.seconds, cost[from].start};
        if (!(sum < next[to])) return;
        next[to] = sum;
        previous[t][to] = from;
      });
      cost = std::move(next);
    }
    auto state = static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    Way way;
    way.posture.resize(T);
    for (std::size_t t = T; t-- > 0;) {
      way.posture[t] = static_cast<int>(posture_of(t, state));
      if (t > 0) state = previous[t][state];
    }
    unwind(way, start_joints(state));
    const bool counting = std::find(counted_.begin(), counted_.end(), true) != counted_.end();
    if (!counting && options_.respect_limits && !fit(way)) return std::nullopt;
    return way;
  }

  /// Angles along the way from those of its start, each step by the shorter way round.
  void unwind(Way& way, const Joints& start) const {
    way.joints.resize(static_cast<Eigen::Index>(layers_.size()), 6);
    way.joints.row(0) = start.transpose();
    for (std::size_t t = 1; t < layers_.size(); ++t) {
      const auto row = static_cast<Eigen::Index>(t);
      const auto from = static_cast<std::size_t>(way.posture[t - 1]), to = static_cast<std::size_t>(way.posture[t]);
      const Edge& e = edges_[t][from * layers_[t].size() + to];
      for (int j = 0; j < 6; ++j) {
        const double turns = std::nearbyint((way.joints(row - 1, j) - layers_[t - 1][from].joints[j]) / turn);
        way.joints(row, j) = layers_[t][to].joints[j] + turn * (turns + e.turns[static_cast<std::size_t>(j)]);
      }
      way.largest_ratio = std::max(way.largest_ratio, e.jumps() ? e.ratio - jump_cost : e.ratio);
    }
  }

  [[nodiscard]] bool fit(const Way& way) const {
    const Joints lowest = way.joints.colwise().minCoeff().transpose(),
                 highest = way.joints.colwise().maxCoeff().transpose();
    return (lowest - limits_.position.col(0)).minCoeff() >= 0.0 &&
           (limits_.position.col(1) - highest).minCoeff() >= 0.0;
  }

  const Layers& layers_;
  const JointLimits& limits_;
  const GraphOptions& options_;
  bool jumping_ = true;                   // steps that are jumps are looked at
  std::array<bool, 6> counted_{};         // joints whose whole turns are states of their own
  Eigen::Matrix<double, 6, 2> range_;     // of their turns, within limits_.position [rad]
  std::vector<std::vector<Edge>> edges_;  // [t][from * postures of t + to]
  std::vector<std::vector<Node>> nodes_;
  std::vector<std::size_t> states_;
};

}  // namespace

Way best_way(const std::vector<std::vector<Posture>>& layers, const Vector& times, const JointLimits& limits,
             const GraphOptions& options) {
  Graph graph(layers, times, limits, options);
  if (auto way = graph.solve()) return *std::move(way);
  if (auto way = graph.solve_counting(false)) return *std::move(way);
  if (auto way = graph.solve_counting(true)) return *std::move(way);
  return {{}, {}, 0.0, graph.blocked()};
}

}  // namespace lfd
