// How faithful an import is: a table, a row a thing that can differ, each with its bar, its figure
// and how it was measured.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/libero/imported.h"
#include "runtime/libero/records.h"

namespace probe::libero {

struct FidelityOptions {
  std::string import;    // folder that `libero import` made
  std::string original;  // LIBERO's own folder; empty: rows of its files are not measured
  std::string records;   // of the benchmark's own program; empty: rows of these are not measured
  int starts = 50;       // of a task: how many first ones come to rest
};

// The worse of two deviations: what is no number is worse than any, so that no bar holds it.
inline double worse(double a, double b) { return std::isnan(a) || b <= a ? a : b; }

enum class Held { kYes, kNo, kNotMeasured };
std::string_view to_text(Held held);  // "held", "missed", "not measured"

struct FidelityRow {
  std::string what, bar;
  std::string figure;  // empty where it is not measured
  std::string how;     // or what is lacking
  Held held = Held::kNotMeasured;
  std::vector<std::string> others;  // what is beyond the bar, a line each
};

// Every row, in the order of the table. Fails (kUsage) where the import has no suite, where a file
// of the original or of the records is none, and with the faults of what is simulated.
Result<std::vector<FidelityRow>> measure_fidelity(const FidelityOptions& options);

// ---- a row each; `records` has what the row needs

// Instruction, horizon, order and what the problems say, of all tasks of the original's folder;
// with the recorded table of tasks where there is one.
Result<FidelityRow> tasks_row(Imported& imported, const std::string& original,
                              const Records* records);
// Every stored pose and joint against what the plan begins with.
Result<FidelityRow> starts_row(Imported& imported, const std::string& original);
// libero_object_classes.json: what MuJoCo's compiler made of each model.
Result<FidelityRow> masses_row(Imported& imported, const Records& records);
// reference/osc_unit_*.json: torques of given states.
Result<FidelityRow> torques_row(Imported& imported, const Records& records);
// reference/*_osc.csv: rows for the arm, the fingers and the joints of fixtures.
Result<std::vector<FidelityRow>> steps_rows(Imported& imported, const Records& records);
// libero_settled.npz.
Result<FidelityRow> settling_row(Imported& imported, const Records& records, std::size_t starts);
// reference/*_t10_agentview.png and _wrist.png: the first pictures that a policy gets.
Result<FidelityRow> pictures_row(Imported& imported, const Records& records);

}  // namespace probe::libero
