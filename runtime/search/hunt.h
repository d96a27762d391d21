// What the searches by each method have in common. Internal to this folder.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/search/method/space.h"
#include "runtime/search/search.h"
#include "runtime/search/shown_value.h"
#include "runtime/search/stored_points.h"
#include "runtime/search/trials.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

// A case that fails, and what was drawn beside it where a search found it.
struct Case {
  std::vector<double> values;
  std::optional<std::uint64_t> draw;
};

struct Hunt {
  const SearchOptions& options;
  const BaseTask& base;
  SearchSummary& summary;
  StoredPoints stored_points;
  std::unique_ptr<Solved> solved = nullptr;  // null where nothing is to be proved
  std::string round = {};                    // the folder of the round that is under way
  int rounds = 0;                            // its number, from 1 on
  Case whole;                                // of `minimal`: what is made smaller
  std::vector<KeptPoint> kept = {};          // as a text at the end

  const sema::Space& space() const { return base.space(); }
  void tell(const std::string& what) const {
    if (options.tell) options.tell(what);
  }
  // "is fair", of what was tried or not. Where episodes came to no end that counts, that is no word
  // for it.
  const char* fair_words() const { return summary.invalid > 0 ? "could be tried" : "is fair"; }
  // Begins the next round, of these points.
  Result<PlannedPoints> plan(std::vector<space::Point> points);
  std::string round_folder(int number) const;
  // Runs the policy in the round until `asking` is done. `kind` names its draws.
  Status try_out(const PlannedPoints& planned, const Trials::Asking& asking,
                 const std::string& kind, int first_seed = 0);
  // The same of points of a method's space: `ask` and `tell` are the method's, whose points are
  // planned as they come, one round a batch.
  struct PointMethod {
    std::function<bool()> done;
    std::function<std::span<const Point>()> ask;
    std::function<void(std::span<const Outcome>)> tell;
  };
  Status try_points(const PointMethod& method, const std::string& kind, int first_seed = 0);
  // What is drawn beside a point: the same for the same point, however often it is asked for.
  std::uint64_t draw_of(const std::vector<double>& values) const;
  std::string point_name(const std::vector<double>& values) const;
};

Json json_of(const stats::Count& count);
Json json_of(const stats::Interval& interval);
// By axis, what is changed: {"light.power": 0.31, "words": "drop_on"}.
Json json_of(const sema::Space& space, const std::vector<double>& values);

Status search_boundary(Hunt& hunt);
// A shard of it is a search of its own: other draws and seeds, and its part of the error.
Status search_worst(Hunt& hunt);
inline constexpr int kMostWorstShards = 40;
// Whether a case of a `worst`, as search.json has it, is confirmed.
bool is_confirmed(const Json& one);
// What a `worst` found, in words: a sentence a case, and what they come to. `cases` are as
// search.json has them, `own` are the failures of the task itself among `trials` of all.
std::vector<std::string> worst_lines(const Json& cases, const stats::Count& own, int trials);
Status search_minimal(Hunt& hunt);
// The case that `minimal` is asked about. Fails (kUsage) where it is none of the space.
Result<Case> case_of(const SearchOptions& options, const BaseTask& base);
Status search_axes(Hunt& hunt);

// "light.power 0.3, clutter 2" as values of all axes. Fails (kUsage, where = --at).
Result<std::vector<double>> read_point(const sema::Space& space, const std::string& text);
// A case of a `worst` as its search.json has it. Fails (kUsage, where).
Result<Case> read_case(const sema::Space& space, const Json& one, const std::string& where);
// Values of the axes of a case as json_of wrote it.
Result<std::vector<double>> values_from(const sema::Space& space, const Json& changes);

}  // namespace probe::search
