#include "runtime/export/dataset/provenance.h"

#include <fmt/format.h>

#include <utility>

#include "runtime/base/file.h"
#include "runtime/base/io_failure.h"
#include "runtime/base/json.h"
#include "runtime/base/paths.h"
#include "runtime/store/until_words.h"

namespace probe::dataset {
namespace {

constexpr int kProvenanceVersion = 1;

Status write_text(const std::string& path, const std::string& text) {
  return write_file(path, std::as_bytes(std::span(text)));
}

Json dataset_json(const Provenance::Facts& facts, const Contents& contents) {
  Json json;
  json["version"] = kProvenanceVersion;
  json["demonstrations"] = contents.demonstrations;
  json["episodes"] = contents.episodes;
  json["frames"] = contents.frames;
  json["robot"] = facts.shape.robot;
  json["control_hz"] = facts.shape.control_hz;
  json["fps"] = facts.shape.fps;
  json["joints"] = facts.shape.joints;
  if (!facts.shape.law.empty())
    json["actions"] = {{"law", facts.shape.law}, {"size", facts.shape.action_size}};
  json["cameras"] = Json::array();
  for (const CameraShape& camera : facts.shape.cameras) {
    Json one = {{"name", camera.name}, {"width", camera.width}, {"height", camera.height}};
    if (!camera.views.empty()) one["views"] = camera.views;
    json["cameras"].push_back(std::move(one));
  }
  json["only_success"] = facts.options.only_success;
  json["tasks"] = facts.options.tasks;
  json["rephrase_sha256"] =
      facts.rephrase_sha256.empty() ? Json(nullptr) : Json(facts.rephrase_sha256);
  json["wordings"] = facts.options.wordings;
  json["runs"] = Json::array();
  for (const Source& source : facts.sources) {
    Json run = {{"dir", source.dir},
                {"policy", source.policy},
                {"plan_root", to_hex(source.plan.root())},
                {"episodes", source.rows.size()}};
    if (!source.until.empty()) run["until"] = source.until;
    json["runs"].push_back(std::move(run));
  }
  return json;
}

std::string readme(const Provenance::Facts& facts, const Contents& contents,
                   const std::vector<std::string>& left_out) {
  std::string text = contents.card + "# Demonstrations from simulated episodes\n\n";
  text += fmt::format(
      "{} episodes of {} demonstrations, {} frames at {} a second, robot `{}`. Written by "
      "`vlaprobe "
      "export`: every picture was rendered again from its episode's trace and has the hash of what "
      "the policy saw",
      contents.episodes, contents.demonstrations, contents.frames, facts.shape.fps,
      facts.shape.robot);
  text += facts.options.width > 0
              ? fmt::format(
                    ", before it was resized to {} x {} (bilinear, antialiased, the whole "
                    "picture whatever its shape).\n\n",
                    facts.options.width, facts.options.height)
              : ".\n\n";
  if (facts.shape.control_hz != facts.shape.fps)
    text += fmt::format("The control rate is {} Hz; times are written as if it were {}.\n\n",
                        facts.shape.control_hz, facts.shape.fps);
  text += contents.readme +
          "\n## Sources\n\n| run | policy | plan | episodes taken |\n|---|---|---|---|\n";
  for (const Source& source : facts.sources)
    text += fmt::format("| `{}` | `{}` | `{}` | {} |\n", source.dir, source.policy,
                        to_hex(source.plan.root()), source.rows.size());
  for (const Source& source : facts.sources) {
    if (!source.until.empty())
      text += fmt::format("\n`{}` {}: which episodes it has depends on how they ended.\n", source.dir,
                          store::what_chose(source.until));
  }
  text += "\n`" + std::string(kDemonstrationsPath) +
          "` has each demonstration's task, start, seed, trace, wordings and metrics; `vlaprobe "
          "export --check DIR` holds the dataset against the traces.\n\n## Left out\n\n";
  for (const std::string& sentence : left_out) text += "- " + sentence + "\n";
  if (left_out.empty()) text += "Nothing.\n";
  return text;
}

}  // namespace

Result<std::unique_ptr<Provenance>> Provenance::create(const std::string& dir) {
  PROBE_TRY(make_folders(dir + "/vlaprobe"));
  const std::string path = dir + "/" + kDemonstrationsPath;
  std::FILE* lines = std::fopen(path.c_str(), "wb");
  if (lines == nullptr) return io_failure("cannot be made", path);
  return std::unique_ptr<Provenance>(new Provenance(dir, lines, path));
}

Provenance::~Provenance() {
  if (lines_ != nullptr) std::fclose(lines_);
}

Status Provenance::add(const Demonstration& demonstration) {
  const store::ResultRow& row = demonstration.row;
  Json json;
  json["run"] = demonstration.run;
  json["task"] = row.task;
  json["episode"] = row.episode;
  json["seed"] = row.seed;
  json["policy"] = row.policy;
  json["steps"] = demonstration.steps.size();
  json["success"] = demonstration.success;
  if (demonstration.pushed) json["pushed"] = *demonstration.pushed;
  json["trace_sha256"] = row.trace_sha256;
  json["instruction"] = demonstration.prompt;
  json["wordings"] = demonstration.wordings;
  json["metrics"] = Json::object();
  for (const store::MetricValue& metric : row.metrics)
    json["metrics"][metric.name] = metric.is_bool ? Json(metric.value != 0) : Json(metric.value);
  const std::string text = json.dump() + "\n";
  if (std::fwrite(text.data(), 1, text.size(), lines_) != text.size())
    return io_failure("cannot be written", path_);
  return {};
}

Status Provenance::finish(const Facts& facts, const Contents& contents,
                          const std::vector<std::string>& left_out) {
  if (std::fclose(std::exchange(lines_, nullptr)) != 0)
    return io_failure("cannot be written", path_);
  PROBE_TRY(write_text(dir_ + "/" + kDatasetPath, dataset_json(facts, contents).dump(2) + "\n"));
  return write_text(dir_ + "/README.md", readme(facts, contents, left_out));
}

}  // namespace probe::dataset
