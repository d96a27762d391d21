#include "runtime/libero/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

namespace probe::libero {
namespace {

FidelityRow not_measured(std::string what, std::string bar, std::string lacking) {
  return {std::move(what), std::move(bar), "", std::move(lacking), Held::kNotMeasured, {}};
}

bool has_files(const Records& records, const std::string& ending) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::path(records.folder()) / "reference";
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->path().filename().string().ends_with(ending)) return true;
  }
  return false;
}

// Tasks that are recorded and not in the import: no row below measures them, and that is a row.
Result<std::optional<FidelityRow>> lacking_row(Imported& imported, Records& records) {
  FidelityRow row{"recorded tasks",
                  "all are in the import",
                  "",
                  "what the rows below measure is the others",
                  Held::kNo,
                  {}};
  const std::size_t all = records.tasks().size();
  std::set<std::string> lacking;
  for (const RecordedTask& task : records.tasks()) {
    PROBE_ASSIGN(const bool is_there, imported.has(task.suite, task.name()));
    if (is_there) continue;
    lacking.insert(task.key());
    row.others.push_back(task.key() + ": is not in the import");
  }
  if (lacking.empty()) return std::optional<FidelityRow>();
  if (lacking.size() == all)
    return Failure{Fault::kUsage, "the import has none of the recorded tasks", imported.folder()};
  records.leave_out([&](const RecordedTask& task) { return lacking.contains(task.key()); });
  row.figure = fmt::format("{} of {}", all - lacking.size(), all);
  return std::optional(std::move(row));
}

}  // namespace

std::string_view to_text(Held held) {
  switch (held) {
    case Held::kYes:
      return "held";
    case Held::kNo:
      return "missed";
    case Held::kNotMeasured:
      return "not measured";
  }
  return "";
}

Result<std::vector<FidelityRow>> measure_fidelity(const FidelityOptions& options) {
  Imported imported(options.import);
  PROBE_TRY(imported.check());
  std::optional<Records> records;
  if (!options.records.empty()) {
    PROBE_ASSIGN(Records opened, Records::open(options.records));
    records.emplace(std::move(opened));
  }
  std::vector<FidelityRow> rows;
  const auto lacks = [&](const std::string& file) {
    return records ? "the records have no " + file : "no records: `--records DIR`";
  };
  if (options.original.empty()) {
    const std::string why = "no folder of LIBERO: `--libero DIR`";
    rows.push_back(not_measured("instructions, horizons, goals, order", "all", why));
    rows.push_back(not_measured("starts", "1e-9 m, 1e-8 rad", why));
  } else {
    PROBE_ASSIGN(rows.emplace_back(),
                 tasks_row(imported, options.original, records ? &*records : nullptr));
    PROBE_ASSIGN(rows.emplace_back(), starts_row(imported, options.original));
  }
  if (records) {
    PROBE_ASSIGN(const auto lacking, lacking_row(imported, *records));
    if (lacking) rows.push_back(*lacking);
  }
  if (records && records->has("libero_object_classes.json")) {
    PROBE_ASSIGN(rows.emplace_back(), masses_row(imported, *records));
    PROBE_ASSIGN(rows.emplace_back(), rules_row(imported, *records));
  } else {
    rows.push_back(not_measured("rules of success", "all equal", lacks("libero_object_classes.json")));
    rows.push_back(not_measured("masses, centres, inertias", "1e-6, relative",
                                lacks("libero_object_classes.json")));
  }
  if (records && has_files(*records, ".json") && has_files(*records, "_osc.csv")) {
    PROBE_ASSIGN(rows.emplace_back(), torques_row(imported, *records));
    PROBE_ASSIGN(const std::vector<FidelityRow> steps, steps_rows(imported, *records));
    rows.insert(rows.end(), steps.begin(), steps.end());
  } else {
    rows.push_back(
        not_measured("torques of given states", "1e-9 N m", lacks("reference/osc_unit_*.json")));
    rows.push_back(not_measured("arm over the recorded steps", "1 mrad, 0.5 mm",
                                lacks("reference/*_osc.csv")));
  }
  if (records && records->has("libero_settled.npz")) {
    PROBE_ASSIGN(
        rows.emplace_back(),
        settling_row(imported, *records, static_cast<std::size_t>(std::max(options.starts, 0))));
  } else {
    rows.push_back(not_measured("things behind the ten waiting steps",
                                "95 % within 2 mm and 2 degrees", lacks("libero_settled.npz")));
  }
  if (records && has_files(*records, "_t0_geometry.npz")) {
    PROBE_ASSIGN(rows.emplace_back(), masks_row(imported, *records));
  } else {
    rows.push_back(not_measured("masks of objects", "intersection over union 0.97",
                                lacks("reference/*_t0_geometry.npz")));
  }
  if (records && has_files(*records, "_t10_agentview.png")) {
    PROBE_ASSIGN(const auto pictures, pictures_rows(imported, *records, options.sheets));
    rows.insert(rows.end(), pictures.begin(), pictures.end());
  } else {
    for (const char* what : {"pictures of recorded states", "first pictures of a policy"})
      rows.push_back(not_measured(what, "6 levels each, 3 in the median",
                                  lacks("reference/*_t10_agentview.png")));
  }
  return rows;
}

}  // namespace probe::libero
