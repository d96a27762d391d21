#include "runtime/libero/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/libero/zip.h"
#include "runtime/wire/npy.h"

namespace probe::libero {

std::string RecordedTask::key() const { return fmt::format("{}_{:02}", suite, index); }

std::string RecordedTask::name() const {
  std::string name = stem;
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return name;
}

namespace {

bool is_of(const Json& json, JsonKind kind) {
  switch (kind) {
    case JsonKind::kObject:
      return json.is_object();
    case JsonKind::kArray:
      return json.is_array();
    case JsonKind::kText:
      return json.is_string();
    case JsonKind::kNumber:
      return json.is_number() && std::isfinite(json.get<double>());
  }
  return false;
}

std::string_view word_of(JsonKind kind) {
  switch (kind) {
    case JsonKind::kObject:
      return "an object";
    case JsonKind::kArray:
      return "an array";
    case JsonKind::kText:
      return "a text";
    case JsonKind::kNumber:
      return "a finite number";
  }
  return "";
}

// That everything is there that rows ask of a task's entry.
Status check_task(const Json& said, const std::string& where) {
  for (const char* key : {"suite", "file", "language"})
    PROBE_TRY(member(said, key, JsonKind::kText, where));
  for (const char* key : {"index", "horizon"})
    PROBE_TRY(member(said, key, JsonKind::kNumber, where));
  PROBE_TRY(member(said, "goal", JsonKind::kArray, where));
  for (const char* key : {"objects", "fixtures"}) {
    PROBE_ASSIGN(const Json* things, member(said, key, JsonKind::kObject, where));
    for (const auto& [name, thing] : things->items()) {
      PROBE_TRY(member(thing, "cls", JsonKind::kText, where + ", " + name));
      if (std::string_view(key) == "fixtures")
        PROBE_TRY(member(thing, "joints", JsonKind::kArray, where + ", " + name));
    }
  }
  return {};
}

}  // namespace

Result<const Json*> member(const Json& of, const std::string& key, JsonKind kind,
                           const std::string& where) {
  const Json* const found = of.is_object() ? of.find(key) : nullptr;
  if (found == nullptr) return Failure{Fault::kUsage, "there is no `" + key + "`", where};
  if (!is_of(*found, kind))
    return Failure{Fault::kUsage, fmt::format("`{}` is not {}", key, word_of(kind)), where};
  return found;
}

Result<std::vector<double>> numbers(const Json& of, const std::string& key, std::size_t count,
                                    const std::string& where) {
  PROBE_ASSIGN(const Json* all, member(of, key, JsonKind::kArray, where));
  std::vector<double> out;
  for (const Json& number : *all) {
    // A matrix may be written row by row.
    if (number.is_array()) {
      for (const Json& inner : number) {
        if (!is_of(inner, JsonKind::kNumber))
          return Failure{Fault::kUsage, "`" + key + "` has what is no number", where};
        out.push_back(inner.get<double>());
      }
      continue;
    }
    if (!is_of(number, JsonKind::kNumber))
      return Failure{Fault::kUsage, "`" + key + "` has what is no number", where};
    out.push_back(number.get<double>());
  }
  if (count != 0 && out.size() != count)
    return Failure{Fault::kUsage,
                   fmt::format("`{}` has {} numbers, not {}", key, out.size(), count), where};
  return out;
}

Result<Json> Records::json(const std::string& file) const {
  PROBE_ASSIGN(const std::string bytes, text(file));
  Json parsed = Json::parse(bytes);
  if (!parsed.is_object() && !parsed.is_array())
    return Failure{Fault::kUsage, "this is no JSON", file};
  return parsed;
}

Result<Records> Records::open(const std::string& folder) {
  const std::string file = "libero_tasks.json";
  Records records;
  records.folder_ = folder;
  PROBE_ASSIGN(const Json all, records.json(file));
  PROBE_ASSIGN(const Json* tasks, member(all, "tasks", JsonKind::kArray, file));
  for (const Json& said : *tasks) {
    PROBE_TRY(check_task(said, fmt::format("{}, task {}", file, records.tasks_.size())));
    RecordedTask& task = records.tasks_.emplace_back();
    task.suite = said["suite"].text();
    task.stem = said["file"].text();
    if (task.stem.ends_with(".bddl")) task.stem.resize(task.stem.size() - 5);
    task.index = said["index"].get<std::size_t>();
    task.said = said;
  }
  return records;
}

bool Records::has(const std::string& file) const {
  std::error_code error;
  return std::filesystem::is_regular_file(std::filesystem::path(folder_) / file, error);
}

Result<std::string> Records::text(const std::string& file) const {
  return read_file((std::filesystem::path(folder_) / file).string(),
                   {.most = std::size_t{1} << 28, .code = Fault::kUsage, .only_begin = false});
}

namespace {

// A row of a state: time, arm, fingers, objects, joints of fixtures, then velocities.
constexpr std::size_t kTime = 1, kArm = 7, kFingers = 2, kPose = 7;

std::size_t fixture_joints_of(const RecordedTask& task) {
  std::size_t joints = 0;
  for (const auto& [name, fixture] : task.said["fixtures"].items())
    joints += fixture["joints"].size();
  return joints;
}

std::size_t least_width(const RecordedTask& task) {
  return kTime + kArm + kFingers + kPose * task.said["objects"].size() + fixture_joints_of(task);
}

// Of a row of least_width() numbers or more.
RecordedState state_of(const RecordedTask& task, const double* row) {
  RecordedState state;
  const double* q = row + kTime;
  state.arm.assign(q, q + kArm);
  q += kArm;
  state.fingers.assign(q, q + kFingers);
  q += kFingers;
  for (std::size_t i = 0; i < task.said["objects"].size(); ++i, q += kPose)
    state.objects.push_back({Vec3(q[0], q[1], q[2]), Quat(q[3], q[4], q[5], q[6]).normalized()});
  state.fixture_joints.assign(q, q + fixture_joints_of(task));
  return state;
}

}  // namespace

Result<std::vector<RecordedState>> Records::settled(const RecordedTask& task) const {
  std::vector<RecordedState> states;
  PROBE_ASSIGN(const std::string bytes, text("libero_settled.npz"));
  const std::span<const std::uint8_t> archive(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                              bytes.size());
  PROBE_ASSIGN(
      const std::optional<std::string> member,
      find_zip_member(archive, task.key() + ".npy", std::size_t{1} << 24, "libero_settled.npz"));
  if (!member) return states;  // of some tasks alone
  const std::string where = "libero_settled.npz: " + task.key();
  const auto read = wire::from_npy(wire::Bytes(member->begin(), member->end()));
  if (!read) return Failure{Fault::kUsage, read.failure().message, where};
  const wire::Array& rows = *read;
  if (rows.dtype != "<f8")
    return Failure{Fault::kUsage, fmt::format("expected float64, `<f8`, found `{}`", rows.dtype),
                   where};
  if (rows.shape.size() != 2) return Failure{Fault::kUsage, "expected a row a start", where};
  const auto count = static_cast<std::size_t>(rows.shape[0]);
  const auto width = static_cast<std::size_t>(rows.shape[1]);
  if (rows.bytes.size() != count * width * sizeof(double) || width < least_width(task))
    return Failure{Fault::kUsage, "its rows are no states of this task", where};
  std::vector<double> values(count * width);
  if (!values.empty()) std::memcpy(values.data(), rows.bytes.data(), rows.bytes.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      return Failure{Fault::kUsage, fmt::format("start {} has what is no number", i / width),
                     where};
  }
  for (std::size_t r = 0; r < count; ++r) states.push_back(state_of(task, &values[r * width]));
  return states;
}

Result<std::optional<RecordedState>> Records::behind_waiting(const RecordedTask& task) const {
  const std::string file = "reference/" + task.key() + "_state.json";
  if (!has(file)) return std::optional<RecordedState>();
  PROBE_ASSIGN(const Json said, json(file));
  PROBE_ASSIGN(const std::vector<double> row, numbers(said, "state_t10", 0, file));
  if (row.size() < least_width(task))
    return Failure{Fault::kUsage, "`state_t10` is no state of this task", file};
  return std::optional(state_of(task, row.data()));
}

Result<std::size_t> RecordedTable::column(const std::string& name) const {
  const auto at = std::ranges::find(names, name);
  if (at == names.end())
    return Failure{Fault::kUsage, "the table has no column `" + name + "`", ""};
  return static_cast<std::size_t>(at - names.begin());
}

Result<RecordedTable> read_table(const std::string& text, const std::string& where) {
  RecordedTable table;
  std::string_view rest = text;
  std::size_t number = 0;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    std::vector<std::string_view> cells;
    for (std::string_view left = line;; left.remove_prefix(left.find(',') + 1)) {
      cells.push_back(left.substr(0, left.find(',')));
      if (left.find(',') == left.npos) break;
    }
    if (number == 1) {
      table.names.assign(cells.begin(), cells.end());
      continue;
    }
    const std::string place = fmt::format("{}:{}", where, number);
    if (cells.size() != table.names.size())
      return Failure{Fault::kUsage,
                     fmt::format("expected {} cells, found {}", table.names.size(), cells.size()),
                     place};
    std::vector<double>& row = table.rows.emplace_back();
    for (const std::string_view cell : cells) {
      double value = 0;
      const auto [at, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || at != cell.data() + cell.size() || !std::isfinite(value))
        return Failure{Fault::kUsage, fmt::format("expected a number, found `{}`", cell), place};
      row.push_back(value);
    }
  }
  return table;
}

}  // namespace probe::libero
