#include "runtime/export/dataset/named_runs.h"

#include <utility>

#include "runtime/base/file.h"
#include "runtime/export/dataset/provenance.h"
#include "runtime/export/dataset/source.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"

namespace probe::dataset {
namespace {

bool has_texts(const Json& json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (!json.contains(key) || !json.at(key).is_string()) return false;
  }
  return true;
}
bool has_wholes(const Json& json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (!json.contains(key) || !json.at(key).is_number_integer()) return false;
  }
  return true;
}
bool has_arrays(const Json& json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (!json.contains(key) || !json.at(key).is_array()) return false;
  }
  return true;
}
bool are_texts(const Json& array) {
  for (const Json& element : array) {
    if (!element.is_string()) return false;
  }
  return true;
}

std::optional<Shape> shape_of_json(const Json& json) {
  if (!has_texts(json, {"robot"}) || !has_wholes(json, {"fps"}) ||
      !has_arrays(json, {"joints", "cameras"}) || !are_texts(json.at("joints")) ||
      !json.contains("control_hz") || !json.at("control_hz").is_number() ||
      json.at("fps").get<int>() < 1 || json.at("joints").empty())
    return std::nullopt;
  Shape shape;
  shape.robot = json.at("robot").text();
  shape.fps = json.at("fps").get<int>();
  shape.control_hz = json.at("control_hz").get<double>();
  shape.joints = json.at("joints").get<std::vector<std::string>>();
  if (json.contains("actions")) {
    const Json& actions = json.at("actions");
    if (!has_texts(actions, {"law"}) || !has_wholes(actions, {"size"})) return std::nullopt;
    shape.law = actions.at("law").text();
    const int size = actions.at("size").get<int>();
    if (size < 2 || static_cast<std::size_t>(size) > shape.joints.size() + 1) return std::nullopt;
    shape.action_size = static_cast<std::size_t>(size);
  }
  for (const Json& camera : json.at("cameras")) {
    if (!has_texts(camera, {"name"}) || !has_wholes(camera, {"width", "height"}))
      return std::nullopt;
    shape.cameras.push_back(
        {camera.at("name").text(), camera.at("width").get<int>(), camera.at("height").get<int>()});
    if (!camera.contains("views")) continue;
    if (!camera.at("views").is_array() || !are_texts(camera.at("views"))) return std::nullopt;
    shape.cameras.back().views = camera.at("views").get<std::vector<std::string>>();
  }
  return shape;
}

}  // namespace

Result<NamedRuns> NamedRuns::open(const std::string& dir, const std::vector<std::string>& runs) {
  NamedRuns out;
  const std::string path = dir + "/" + kDatasetPath;
  PROBE_ASSIGN(const std::string text, read_file(path));
  const Json json = Json::parse(text);
  const auto shape = shape_of_json(json);
  if (!shape || !has_arrays(json, {"runs"}) || !json.contains("only_success") ||
      !json.at("only_success").is_boolean())
    return Failure{Fault::kUsage, "is not what `vlaprobe export` writes", path};
  out.shape_ = *shape;
  out.only_success_ = json.at("only_success").get<bool>();
  if (!runs.empty() && runs.size() != json.at("runs").size())
    return Failure{Fault::kUsage,
                   "was made of " + std::to_string(json.at("runs").size()) + " runs, and " +
                       std::to_string(runs.size()) + " are given",
                   dir};
  std::size_t number = 0;
  for (const Json& named : json.at("runs")) {
    if (!has_texts(named, {"dir", "plan_root"}))
      return Failure{Fault::kUsage, "names a run in another way than `vlaprobe export`", path};
    const std::string& name = named.at("dir").text();
    const std::string& place = runs.empty() ? name : runs[number];
    ++number;
    auto plan = store::open_run_plan(place);
    if (!plan) {
      Failure failure = plan.failure();
      if (runs.empty()) failure.message += "; --check DIR RUN... says where the runs are now";
      return failure;
    }
    if (to_hex(plan->root()) != named.at("plan_root").text())
      return Failure{Fault::kUsage, "is a run of another plan than the dataset's", place};
    Run run{place, std::move(*plan), {}};
    PROBE_ASSIGN(auto rows, store::read_results(place));
    for (store::ResultRow& row : rows) run.rows.emplace(store::key_of(row), std::move(row));
    out.runs_.emplace(name, std::move(run));
  }
  out.path_ = dir + "/" + kDemonstrationsPath;
  out.lines_.open(out.path_, std::ios::binary);
  if (!out.lines_) return Failure{Fault::kIo, "cannot be read", out.path_};
  return out;
}

Result<std::optional<NamedDemonstration>> NamedRuns::next() {
  std::string line;
  if (!std::getline(lines_, line)) return std::optional<NamedDemonstration>();
  const std::string place = path_ + ":" + std::to_string(++line_);
  const Json json = Json::parse(line);
  if (!has_texts(json, {"run", "task", "trace_sha256", "instruction"}) ||
      !has_wholes(json, {"episode", "seed"}) || !has_arrays(json, {"wordings"}) ||
      !are_texts(json.at("wordings")))
    return Failure{Fault::kUsage, "is not what `vlaprobe export` writes", place};
  const auto run = runs_.find(json.at("run").text());
  if (run == runs_.end())
    return Failure{Fault::kUsage, "is of a run that the dataset does not name", place};
  const store::EpisodeKey key{json.at("task").text(), json.at("episode").get<int>(),
                              json.at("seed").get<int>()};
  const auto row = run->second.rows.find(key);
  if (row == run->second.rows.end())
    return Failure{Fault::kTrace, "the run has no such episode", store::to_text(key)};
  if (row->second.invalid)
    return Failure{Fault::kTrace, "the run's episode is invalid now: " + *row->second.invalid,
                   store::to_text(key)};
  if (row->second.trace_sha256 != json.at("trace_sha256").text())
    return Failure{Fault::kTrace, "the run has another trace of it than the dataset was made of",
                   store::to_text(key)};
  const plan::Plan& plan = run->second.plan;
  PROBE_ASSIGN(store::Trace trace, store::prove(plan, row->second));
  if (const auto why = lateness(plan, row->second))
    return Failure{Fault::kTrace, "is nothing to learn from: " + *why, store::to_text(key)};
  if (trace.header.prompt != json.at("instruction").text())
    return Failure{Fault::kTrace, "has another instruction than the dataset says",
                   store::to_text(key)};
  const plan::SceneRecord& scene = plan.scenes()[plan.tasks()[*plan.find_task(key.task)].scene];
  return std::optional(NamedDemonstration{
      store::to_text(key), run->second.dir, &plan, row->second.trace_sha256, std::move(trace),
      json.at("wordings").get<std::vector<std::string>>(), is_success(row->second),
      Pose{to_vec(scene.base_position), to_quat(scene.base_rotation)},
      shape_.cameras == cameras_of(plan, plan.tasks()[*plan.find_task(key.task)])});
}

}  // namespace probe::dataset
