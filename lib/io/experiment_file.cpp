#include "lfdtools/io/experiment_file.hpp"

#include "json_check.hpp"
#include "lfdtools/io/json_writer.hpp"
#include "lfdtools/io/provenance.hpp"

namespace lfd {
namespace {

constexpr const char* format = "lfdtools.experiment";
constexpr std::size_t most_holes = 10'000;
constexpr long long most_repetitions = 1'000'000;

/// Overwrites the default where the member is there.
void maybe(const JsonView& object, const char* key, double& value) {
  if (const auto view = object.find(key)) value = view->number();
}

void maybe(const JsonView& object, const char* key, Vector& value, Eigen::Index length) {
  // An empty vector says that there is none.
  if (const auto view = object.find(key)) value = view->size() == 0 ? Vector() : view->vector(length);
}

std::vector<Hole> read_holes(const JsonView& list, Eigen::Index D) {
  if (list.size() > most_holes) list.fail("json.out_of_range", "there are over 10000 holes");
  std::vector<Hole> holes;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView hole = list.at(i);
    hole.only({"target", "position"});
    holes.push_back({hole.at("target").label(), hole.at("position").vector(D)});
  }
  return holes;
}

Bump read_bump(const JsonView& view, Eigen::Index D) {
  view.only({"exponent", "constant", "linear", "quadratic", "sines", "gaussians"});
  Bump bump;
  maybe(view, "exponent", bump.exponent);
  maybe(view, "constant", bump.constant);
  maybe(view, "linear", bump.linear, D);
  if (const auto quadratic = view.find("quadratic"); quadratic && quadratic->size() > 0) {
    bump.quadratic = quadratic->matrix(D, D);
  }
  if (const auto list = view.find("sines")) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      const JsonView term = list->at(i);
      term.only({"amplitude", "rates", "phase"});
      bump.sines.push_back({term.at("amplitude").number(), term.at("rates").vector(D), 0});
      maybe(term, "phase", bump.sines.back().phase);
    }
  }
  if (const auto list = view.find("gaussians")) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      const JsonView term = list->at(i);
      term.only({"amplitude", "center", "width"});
      bump.gaussians.push_back(
          {term.at("amplitude").number(), term.at("center").vector(D), term.at("width").positive()});
    }
  }
  return bump;
}

Obstacle read_obstacle(const JsonView& view, Eigen::Index D) {
  view.only({"center", "axis", "radius", "clearance", "softness", "exponent", "ways"});
  Obstacle obstacle;
  obstacle.center = view.at("center").vector(D);
  maybe(view, "axis", obstacle.axis, D);
  maybe(view, "radius", obstacle.radius);
  maybe(view, "clearance", obstacle.clearance);
  maybe(view, "softness", obstacle.softness);
  maybe(view, "exponent", obstacle.exponent);
  const JsonView ways = view.at("ways");
  for (std::size_t i = 0; i < ways.size(); ++i) obstacle.ways.push_back(ways.at(i).vector(D));
  return obstacle;
}

void read_noise(const JsonView& view, TeacherNoise& noise) {
  view.only({"duration_sd", "tempo_sd", "wander_sd", "tremor_sd"});
  maybe(view, "duration_sd", noise.duration_sd);
  maybe(view, "tempo_sd", noise.tempo_sd);
  maybe(view, "wander_sd", noise.wander_sd, -1);
  maybe(view, "tremor_sd", noise.tremor_sd);
}

void write_holes(JsonWriter& json, const char* key, const std::vector<Hole>& holes) {
  json.key(key).begin_array();
  for (const Hole& hole : holes) {
    json.begin_object();
    write_labels(json, {hole.target, {}, {}, {}});
    json.member("position", hole.position).end_object();
  }
  json.end_array();
}

void write_bump(JsonWriter& json, const Bump& bump) {
  json.begin_object().member("exponent", bump.exponent).member("constant", bump.constant).member("linear", bump.linear);
  json.member("quadratic", bump.quadratic).key("sines").begin_array();
  for (const SineTerm& term : bump.sines) {
    json.begin_object().member("amplitude", term.amplitude).member("rates", term.rates).member("phase", term.phase);
    json.end_object();
  }
  json.end_array().key("gaussians").begin_array();
  for (const GaussianTerm& term : bump.gaussians) {
    json.begin_object().member("amplitude", term.amplitude).member("center", term.center).member("width", term.width);
    json.end_object();
  }
  json.end_array().end_object();
}

void write_obstacle(JsonWriter& json, const Obstacle& obstacle) {
  json.key("obstacle").begin_object().member("center", obstacle.center).member("axis", obstacle.axis);
  json.member("radius", obstacle.radius).member("clearance", obstacle.clearance).member("softness", obstacle.softness);
  json.member("exponent", obstacle.exponent).key("ways").begin_array();
  for (const Vector& way : obstacle.ways) json.vector(way);
  json.end_array().end_object();
}

}  // namespace

Experiment read_experiment(const JsonDocument& document) {
  document.expect(format);
  const JsonView root = document.root();
  root.only({"format", "version", "name", "columns", "start", "holes", "new_holes", "repetitions", "seed",
             "duration_mean", "rate", "noise", "origin", "bumps", "approach", "obstacle"});
  Experiment experiment;
  if (const auto name = root.find("name")) experiment.name = name->string();
  if (const auto columns = root.find("columns")) experiment.columns = columns->strings();
  const auto D = static_cast<Eigen::Index>(experiment.columns.size());
  experiment.start = root.at("start").vector(D);
  experiment.holes = read_holes(root.at("holes"), D);
  if (const auto holes = root.find("new_holes")) experiment.new_holes = read_holes(*holes, D);
  if (const auto count = root.find("repetitions")) experiment.repetitions = count->integer(1, most_repetitions);
  if (const auto seed = root.find("seed")) experiment.seed = seed->unsigned_integer();
  maybe(root, "duration_mean", experiment.duration_mean);
  maybe(root, "rate", experiment.rate);
  if (const auto noise = root.find("noise")) read_noise(*noise, experiment.noise);
  maybe(root, "origin", experiment.origin, D);
  if (const auto bumps = root.find("bumps")) {
    for (std::size_t i = 0; i < bumps->size(); ++i) experiment.bumps.push_back(read_bump(bumps->at(i), D));
  }
  if (const auto approach = root.find("approach")) {
    approach->only({"offset", "exponent"});
    maybe(*approach, "offset", experiment.approach.offset, D);
    maybe(*approach, "exponent", experiment.approach.exponent);
  }
  if (const auto obstacle = root.find("obstacle")) experiment.obstacle = read_obstacle(*obstacle, D);
  checked(root, [&] { check(experiment); });
  return experiment;
}

void write_experiment(const Experiment& experiment, Output& out) {
  JsonWriter json;
  json.begin_object().member("format", format).member("version", 1).member("name", experiment.name);
  json.member("columns", experiment.columns).member("start", experiment.start);
  write_holes(json, "holes", experiment.holes);
  write_holes(json, "new_holes", experiment.new_holes);
  json.member("repetitions", experiment.repetitions).key("seed").unsigned_integer(experiment.seed);
  json.member("duration_mean", experiment.duration_mean).member("rate", experiment.rate).key("noise").begin_object();
  json.member("duration_sd", experiment.noise.duration_sd).member("tempo_sd", experiment.noise.tempo_sd);
  json.member("wander_sd", experiment.noise.wander_sd).member("tremor_sd", experiment.noise.tremor_sd).end_object();
  json.member("origin", experiment.origin).key("bumps").begin_array();
  for (const Bump& bump : experiment.bumps) write_bump(json, bump);
  json.end_array().key("approach").begin_object().member("offset", experiment.approach.offset);
  json.member("exponent", experiment.approach.exponent).end_object();
  if (experiment.obstacle) write_obstacle(json, *experiment.obstacle);
  json.end_object().write_line(out);
}

}  // namespace lfd
