#include "runtime/search/hunt.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "runtime/base/hash_number.h"
#include "runtime/base/paths.h"
#include "runtime/base/sha256.h"
#include "runtime/base/spelling.h"
#include "runtime/search/scale.h"

namespace probe::search {

namespace fs = std::filesystem;

Result<PlannedPoints> Hunt::plan(std::vector<space::Point> points) {
  round = round_folder(++rounds);
  if (options.proves) {
    if (!solved) {
      run::RunOptions expert;
      expert.jobs = options.run.jobs;
      expert.if_changed = options.run.if_changed;
      solved = std::make_unique<Solved>(base, expert);
    }
  }
  PROBE_ASSIGN(PlannedPoints planned, plan_points(base, std::move(points), stored_points, round));
  if (solved) PROBE_TRY(solved->begin(planned, round));
  return planned;
}

std::string Hunt::round_folder(int number) const {
  return (fs::path(options.run.out) / "rounds" / fmt::format("{:03d}", number)).string();
}

Status Hunt::try_out(const PlannedPoints& planned, const Trials::Asking& asking,
                     const std::string& kind, int first_seed) {
  run::RunOptions run = options.run;
  run.out = (fs::path(round) / "policy").string();
  Trials trials(base, planned, run, solved.get(), options.seed, kind, first_seed);
  // Of boundaries whole sides are shared out: what is asked next depends on what was found.
  if (options.method == Method::kAxes) trials.share(options.run.shard, options.run.shards);
  if (is_folder(round_folder(rounds + 1))) trials.mark_over();
  const Status ran = trials.run(asking);
  summary.episodes += trials.episodes();
  summary.ran += trials.ran();
  summary.left_out += trials.unfair() + trials.invalid();
  summary.invalid += trials.invalid();
  if (summary.first_invalid.empty()) summary.first_invalid = trials.first_invalid();
  for (const std::string& note : trials.notes()) {
    if (std::ranges::find(summary.notes, note) == summary.notes.end())
      summary.notes.push_back(note);
  }
  return ran;
}

Status Hunt::try_points(const PointMethod& method, const std::string& kind, int first_seed) {
  while (!method.done()) {
    const std::span<const Point> asked = method.ask();
    std::vector<space::Point> points;
    std::map<std::vector<double>, std::size_t> index;
    std::map<std::size_t, std::uint64_t> numbers;
    std::vector<Trial> trials;
    for (const Point& point : asked) {
      const std::vector<double> values = space::seen_values(space(), values_of(space(), point));
      std::size_t at = kBase;
      if (!space::changed_axes(space(), values).empty()) {
        const auto [known, is_new] = index.try_emplace(values, points.size());
        at = known->second;
        if (is_new) points.push_back({point_name(values), values, draw_of(values), {}});
      }
      trials.push_back({at, numbers[at]++});
    }
    PROBE_ASSIGN(const PlannedPoints planned, plan(std::move(points)));
    tell(fmt::format("round {}: {} trials of {} points", rounds, trials.size(), index.size()));
    bool is_told = false;
    Trials::Asking asking;
    asking.ask = [&]() -> Result<std::vector<Trial>> {
      return is_told ? std::vector<Trial>{} : trials;
    };
    asking.tell = [&](std::span<const Outcome> outcomes) {
      is_told = true;
      summary.trials += static_cast<int>(outcomes.size());
      method.tell(outcomes);
    };
    // Seeds of its own for each round: the same start and seed would be the same episode.
    constexpr int kSeedsOfRound = 10'000;
    PROBE_TRY(try_out(planned, asking, kind + "/" + std::to_string(rounds),
                      first_seed + rounds * kSeedsOfRound));
  }
  return {};
}

std::uint64_t Hunt::draw_of(const std::vector<double>& values) const {
  Hasher hasher;
  hasher.text("search point").u64(options.seed);
  for (const double value : values) hasher.text(fmt::format("{}", value));
  return little_endian_number(hasher.finish());
}

std::string Hunt::point_name(const std::vector<double>& values) const {
  return fmt::format("{}_{:012x}", space().name, draw_of(values) >> 16);
}

Json json_of(const stats::Count& count) { return {count.k, count.n}; }
Json json_of(const stats::Interval& interval) { return {interval.low, interval.high}; }

Json json_of(const sema::Space& space, const std::vector<double>& values) {
  Json out = Json::object();
  for (const std::size_t i : space::changed_axes(space, values)) {
    const sema::SpaceAxis& axis = space.axes[i];
    if (sema::info_of(axis.kind).spacing == sema::Spacing::kChoice) {
      out[axis.name] = axis.choices[static_cast<std::size_t>(std::llround(values[i]))];
    } else {
      out[axis.name] = values[i];
    }
  }
  return out;
}

namespace {

Failure not_a_point(const std::string& message) { return {Fault::kUsage, message, "--at"}; }

Result<std::size_t> axis_called(const sema::Space& space, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < space.axes.size(); ++i) {
    if (space.axes[i].name == name) return i;
    names.push_back(space.axes[i].name);
  }
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  const std::string near = did_you_mean(name, names);
  return not_a_point("`" + name + "` is no axis of space `" + space.name + "`" +
                     (near.empty() ? "; it has " + known : near));
}

Result<double> choice_of(const sema::SpaceAxis& axis, const std::string& word) {
  for (std::size_t i = 0; i < axis.choices.size(); ++i) {
    if (axis.choices[i] == word) return static_cast<double>(i);
  }
  std::string known;
  for (std::size_t i = 1; i < axis.choices.size(); ++i)
    known += (known.empty() ? "" : ", ") + axis.choices[i];
  return not_a_point("`" + axis.name + "` is one of " + known + ", found `" + word + "`");
}

Status check_inside(const sema::SpaceAxis& axis, double value) {
  if (value >= axis.low - 1e-12 && value <= axis.high + 1e-12) return {};
  return not_a_point("`" + axis.name + "` goes from " + space::value_text(axis, axis.low) + " to " +
                     space::value_text(axis, axis.high) + ", found " +
                     space::value_text(axis, value));
}

}  // namespace

Result<std::vector<double>> read_point(const sema::Space& space, const std::string& text) {
  std::vector<double> values = space::own_values(space);
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    std::string item = text.substr(from, end - from);
    from = end + 1;
    while (!item.empty() && item.front() == ' ') item.erase(0, 1);
    while (!item.empty() && item.back() == ' ') item.pop_back();
    const std::size_t gap = item.find_first_of(" =");
    if (gap == item.npos)
      return not_a_point("expected `AXIS VALUE, AXIS VALUE`, found `" + item + "`");
    const std::string name = item.substr(0, gap);
    std::string word = item.substr(item.find_first_not_of(" =", gap) == item.npos
                                       ? item.size()
                                       : item.find_first_not_of(" =", gap));
    PROBE_ASSIGN(const std::size_t i, axis_called(space, name));
    const sema::SpaceAxis& axis = space.axes[i];
    const sema::SpaceAxisInfo& info = sema::info_of(axis.kind);
    if (info.spacing == sema::Spacing::kChoice) {
      PROBE_ASSIGN(values[i], choice_of(axis, word));
      continue;
    }
    // As value_text writes it: "x 0.31", "2.5cm", "4 steps".
    if (word.starts_with("x ")) word.erase(0, 2);
    double number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    std::string unit = word.substr(static_cast<std::size_t>(stop - word.data()));
    if (unit.starts_with(' ')) unit.erase(0, 1);
    if (error != std::errc() || (!unit.empty() && unit != info.unit))
      return not_a_point("expected a number" +
                         (info.unit.empty() ? "" : " of " + std::string(info.unit)) + " for `" +
                         axis.name + "`, found `" + word + "`");
    values[i] = number / info.per_si;
    PROBE_TRY(check_inside(axis, values[i]));
  }
  return values;
}

Result<std::vector<double>> values_from(const sema::Space& space, const Json& changes) {
  std::vector<double> values = space::own_values(space);
  for (const auto& [name, value] : changes.items()) {
    PROBE_ASSIGN(const std::size_t i, axis_called(space, name));
    if (value.is_string()) {
      PROBE_ASSIGN(values[i], choice_of(space.axes[i], value.text()));
    } else if (value.is_number()) {
      values[i] = value.get<double>();
      PROBE_TRY(check_inside(space.axes[i], values[i]));
    } else {
      return not_a_point("`" + name + "` has neither a number nor a word");
    }
  }
  return values;
}

Result<Case> read_case(const sema::Space& space, const Json& one, const std::string& where) {
  const Json* const changes = one.find("changes");
  if (changes == nullptr || !changes->is_object())
    return Failure{Fault::kUsage, "its case does not say what it changes", where};
  Case found;
  PROBE_ASSIGN(found.values, values_from(space, *changes));
  const std::string draw = one.value("draw", "");
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(draw.data(), draw.data() + draw.size(), number, 16);
  if (draw.empty() || error != std::errc() || end != draw.data() + draw.size())
    return Failure{Fault::kUsage, "its case lacks what was drawn beside it", where};
  found.draw = number;
  return found;
}

}  // namespace probe::search
