// How faithful an import is: a table, a row a thing that can differ, each with its bar, its figure
// and how it was measured.
#pragma once

#include <cmath>
#include <span>
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
  std::string sheets;    // folder for pictures: theirs, ours, what differs; empty: none
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
// Rules of success on stored, settled and made-up states (libero_object_classes.json).
Result<FidelityRow> rules_row(Imported& imported, const Records& records);
// reference/osc_unit_*.json: torques of given states.
Result<FidelityRow> torques_row(Imported& imported, const Records& records);
// reference/*_osc.csv: rows for the arm, the fingers and the joints of fixtures.
Result<std::vector<FidelityRow>> steps_rows(Imported& imported, const Records& records);
// libero_settled.npz.
Result<FidelityRow> settling_row(Imported& imported, const Records& records, std::size_t starts);
// reference/*_t0_geometry.npz: which geom each pixel shows before the waiting steps.
Result<FidelityRow> masks_row(Imported& imported, const Records& records);
// reference/*_t10_agentview.png and _wrist.png, in two rows: drawn in the recorded states, and as a
// policy first gets them, behind our own waiting steps. With `sheets` PNGs there: theirs, ours, and
// four times what differs, TASK_CAMERA.png in the recorded states, TASK_CAMERA_first.png.
Result<std::vector<FidelityRow>> pictures_rows(Imported& imported, const Records& records,
                                               const std::string& sheets);

}  // namespace probe::libero
