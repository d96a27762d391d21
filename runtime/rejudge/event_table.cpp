#include "runtime/rejudge/event_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "runtime/base/csv.h"
#include "runtime/base/json.h"

namespace probe::rejudge {
namespace {

struct ToldNumber {
  std::string name, unit;
  const Told* told = nullptr;
};

// All numbers of an episode in the order in which they are written.
std::vector<ToldNumber> numbers_of(const EpisodeEvents& events) {
  std::vector<ToldNumber> out;
  if (!events.untold.empty()) return out;
  out.push_back({"to_grasp", "s", &events.to_grasp});
  out.push_back({"hand_over", "s", &events.hand_over});
  for (const MotionInfo& motion : all_motions()) {
    out.push_back({std::string(motion.name), std::string(motion.unit),
                   &events.motion[static_cast<std::size_t>(motion.kind)]});
  }
  return out;
}

std::string shown(double value, const std::string& unit) {
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

struct TaskEvents {
  int told = 0, untold = 0;
  std::string first_untold;
  std::vector<const EpisodeEvents*> episodes;
};

// "dropped: 3 of 24 episodes, 4 times".
void put_events(const TaskEvents& tally, std::string& text) {
  for (std::size_t i = 0; i < tally.episodes.front()->counts.size(); ++i) {
    int with = 0;
    double times = 0;
    for (const EpisodeEvents* events : tally.episodes) {
      const double value = events->counts[i].value.value_or(0);
      with += value > 0 ? 1 : 0;
      times += value;
    }
    fmt::format_to(std::back_inserter(text), "  {:<14} {:>4} of {}",
                   event_words(tally.episodes.front()->counts[i].name), with, tally.told);
    if (times > with) fmt::format_to(std::back_inserter(text), ", {:g} times", times);
    text += '\n';
  }
}

// Each subgoal with how many episodes came so far, in order.
void put_progress(const TaskEvents& tally, std::string& text) {
  const EpisodeEvents& first = *tally.episodes.front();
  if (first.subgoals == 0) return;
  text += "  came as far as ";
  for (int k = 0; k < first.subgoals; ++k) {
    const auto reached = std::ranges::count_if(
        tally.episodes, [&](const EpisodeEvents* events) { return events->reached > k; });
    fmt::format_to(std::back_inserter(text), "{}{} {}", k == 0 ? "" : ", ",
                   event_words(first.firsts[static_cast<std::size_t>(k)].first), reached);
  }
  text += '\n';
}

void put_numbers(const TaskEvents& tally, std::string& text) {
  const std::vector<ToldNumber> columns = numbers_of(*tally.episodes.front());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::vector<double> values;
    std::map<std::string, int> reasons;
    for (const EpisodeEvents* events : tally.episodes) {
      const Told& told = *numbers_of(*events)[i].told;
      if (told.value) values.push_back(*told.value);
      if (!told.value) ++reasons[told.why_not];
    }
    std::string said;
    if (!values.empty()) {
      double sum = 0;
      for (const double value : values) sum += value;
      const auto [low, high] = std::ranges::minmax_element(values);
      said = fmt::format("mean {}, {} .. {}",
                         shown(sum / static_cast<double>(values.size()), columns[i].unit),
                         shown(*low, columns[i].unit), shown(*high, columns[i].unit));
    }
    for (const auto& [why, count] : reasons)
      said += fmt::format("{}{} in {}", said.empty() ? "" : "; ", why, count);
    fmt::format_to(std::back_inserter(text), "  {:<14} {}\n", event_words(columns[i].name), said);
  }
}

Json json_of(const EventRow& row) {
  const EpisodeEvents& events = row.events;
  Json out = {{"task", row.row.task},
              {"episode", row.row.episode},
              {"seed", row.row.seed},
              {"policy", row.row.policy}};
  if (!events.untold.empty()) {
    out["untold"] = events.untold;
    return out;
  }
  out["steps"] = row.row.steps;
  out["marks"] = Json::array();
  for (const EventMark& mark : events.marks)
    out["marks"].push_back({{"name", mark.name}, {"step", mark.step}, {"of", mark.bodies}});
  Json& counts = out["events"] = Json::object();
  for (const EventCount& count : events.counts)
    counts[count.name] = count.value ? Json(*count.value) : Json();
  Json& firsts = out["subgoals"] = Json::array();
  for (const auto& [name, step] : events.firsts)
    firsts.push_back({{"name", name}, {"step", step == 0 ? Json() : Json(step)}});
  out["reached"] = events.reached;
  Json& motion = out["motion"] = Json::object();
  Json why = Json::object();
  for (const ToldNumber& number : numbers_of(events)) {
    motion[number.name] = number.told->value ? Json(*number.told->value) : Json();
    if (!number.told->value) why[number.name] = number.told->why_not;
  }
  out["why_not"] = std::move(why);
  return out;
}

// Names in the order in which episodes have them; tasks need not have the same.
std::vector<std::string> names_of(
    std::span<const EventRow> rows,
    const std::function<std::vector<std::string>(const EpisodeEvents&)>& of) {
  std::vector<std::string> names;
  for (const EventRow& row : rows) {
    for (std::string& name : of(row.events)) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
  }
  return names;
}

}  // namespace

std::string event_tally(std::span<const EventRow> rows) {
  std::vector<std::string> order;
  std::map<std::string, TaskEvents> tallies;
  for (const EventRow& row : rows) {
    const auto [at, is_new] = tallies.try_emplace(row.row.task);
    if (is_new) order.push_back(row.row.task);
    TaskEvents& tally = at->second;
    if (row.events.untold.empty()) {
      ++tally.told;
      tally.episodes.push_back(&row.events);
    } else if (tally.untold++ == 0) {
      tally.first_untold =
          fmt::format("episode {} seed {}: {}", row.row.episode, row.row.seed, row.events.untold);
    }
  }
  std::string text;
  for (const std::string& task : order) {
    const TaskEvents& tally = tallies[task];
    fmt::format_to(std::back_inserter(text), "{}: {} episodes", task, tally.told + tally.untold);
    if (tally.untold > 0) {
      fmt::format_to(std::back_inserter(text), ", nothing told of {} ({})", tally.untold,
                     tally.first_untold);
    }
    text += '\n';
    if (tally.episodes.empty()) continue;
    put_events(tally, text);
    put_progress(tally, text);
    put_numbers(tally, text);
  }
  return text;
}

std::string events_to_json(std::span<const EventRow> rows) {
  Json out = Json::array();
  for (const EventRow& row : rows) out.push_back(json_of(row));
  return out.dump(1);
}

std::string events_to_csv(std::span<const EventRow> rows) {
  const auto counts = names_of(rows, [](const EpisodeEvents& events) {
    std::vector<std::string> names;
    for (const EventCount& count : events.counts) names.push_back(count.name);
    return names;
  });
  const auto firsts = names_of(rows, [](const EpisodeEvents& events) {
    std::vector<std::string> names;
    for (const auto& [name, step] : events.firsts) names.push_back(name);
    return names;
  });
  const auto numbers = names_of(rows, [](const EpisodeEvents& events) {
    std::vector<std::string> names;
    for (const ToldNumber& number : numbers_of(events)) names.push_back(number.name);
    return names;
  });
  std::string text = "task,episode,seed,policy,steps,reached,subgoals";
  for (const auto* names : {&counts, &firsts, &numbers}) {
    for (const std::string& name : *names) text += "," + name;
  }
  text += ",why_not\n";
  for (const EventRow& row : rows) {
    const EpisodeEvents& events = row.events;
    const bool is_told = events.untold.empty();
    text += fmt::format("{},{},{},{},", csv_cell(row.row.task), row.row.episode, row.row.seed,
                        csv_cell(row.row.policy));
    text +=
        is_told ? fmt::format("{},{},{}", row.row.steps, events.reached, events.subgoals) : ",,";
    std::string why = events.untold;
    for (const std::string& name : counts) {
      const auto at = std::ranges::find(events.counts, name, &EventCount::name);
      text += ",";
      if (at != events.counts.end() && at->value) text += fmt::format("{:g}", *at->value);
    }
    for (const std::string& name : firsts) {
      const auto at = std::ranges::find(events.firsts, name, &std::pair<std::string, int>::first);
      text += ",";
      if (at != events.firsts.end() && at->second > 0) text += fmt::format("{}", at->second);
    }
    const std::vector<ToldNumber> own = numbers_of(events);
    for (const std::string& name : numbers) {
      const auto at = std::ranges::find(own, name, &ToldNumber::name);
      text += ",";
      if (at == own.end()) continue;
      if (at->told->value) text += fmt::format("{:.9g}", *at->told->value);
      if (!at->told->value) why += (why.empty() ? "" : "; ") + name + ": " + at->told->why_not;
    }
    text += "," + csv_cell(why) + "\n";
  }
  return text;
}

}  // namespace probe::rejudge
