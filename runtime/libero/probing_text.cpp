#include "runtime/libero/probing_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "runtime/libero/crowd.h"
#include "runtime/libero/goal.h"
#include "runtime/libero/start_rows.h"
#include "runtime/libero/words.h"

namespace probe::libero {
namespace {

// The sets of suite/libero/asked.probe: by what is to be done, and by where. Each is there, also
// with nothing in it.
constexpr std::string_view kKinds[] = {"lays",  "fills",  "among",    "onto_one",  "zones",
                                       "opens", "closes", "turns_on", "turns_off", "more"};
// By what their source is like: words.def.
constexpr std::string_view kSources[] = {"bowls",   "mugs",  "cans", "bottles",
                                         "cartons", "boxes", "books"};
struct PlaceRow {
  std::string_view scene, set;
  std::string_view elsewhere;  // whose room it is shown in instead
};
constexpr PlaceRow kPlaces[] = {{"libero_tabletop", "at_table", "libero_study"},
                                {"libero_kitchen", "at_table", "libero_living_room"},
                                {"libero_study", "at_study", "libero_kitchen"},
                                {"libero_living_room", "at_living", "libero_kitchen"},
                                {"libero_floor", "at_floor", "libero_kitchen"}};

std::string shown_elsewhere(const WrittenTask& task) { return task.stage + "_elsewhere"; }

class TaskAsker {
 public:
  TaskAsker(const AskedTask& task, const Things& things)
      : task_(task), problem_(task.problem), things_(things), roles_(roles_of(task.problem)) {}

  // What is to be done. `lays` and `fills` can be said by the names of source and target alone;
  // `among` by that of the target, `onto_one` by that of the source.
  std::string_view kind() const {
    if (problem_.goal.size() != 1) return "more";
    const BddlFact& fact = problem_.goal.front();
    const bool is_on = fact.predicate == "on";
    if (is_on || fact.predicate == "in") {
      const BddlRegion* region = problem_.find_region(fact.arguments[1]);
      if (region != nullptr && !region->ranges.empty()) return "zones";
      const bool is_source = is_told_apart(roles_.source),
                 is_target = is_told_apart(target_thing());
      if (target_name().empty() || (!is_source && !is_target)) return "more";
      if (is_source && is_target) return is_on ? "lays" : "fills";
      return !is_on ? "more" : is_target ? "among" : "onto_one";
    }
    if (fact.predicate == "open") return "opens";
    if (fact.predicate == "close") return "closes";
    if (fact.predicate == "turnon") return "turns_on";
    return fact.predicate == "turnoff" ? "turns_off" : "more";
  }

  // "bowls": what its source is like; empty where it can't be told by its name, or is like nothing.
  std::string_view source_set() const {
    const std::string_view what = kind();
    if (what != "lays" && what != "fills") return {};
    return set_of(problem_.find_object(roles_.source)->category);
  }

  // Whether two things that have no role have one name.
  bool has_twins() const {
    std::set<std::string_view> names;
    return std::ranges::any_of(roles_.distractors, [&](const std::string& name) {
      return !names.insert(name_of_object(name)).second;
    });
  }

  // What else can stand there of what is declared, for a task that puts one thing.
  std::vector<Foreign> foreign(const std::vector<Standing>& declared, std::size_t turn) const {
    const std::string_view what = kind();
    if (what != "lays" && what != "fills") return {};
    return crowd(problem_, things_, task_.written.table, declared, turn);
  }

  // `is_shown`: there is a scene in another room; `foreign`: what else stands there.
  std::string text(std::vector<SuiteText::Table>& tables, bool is_shown,
                   const std::vector<Foreign>& foreign) const {
    const std::string& id = task_.written.id;
    const std::string_view what = kind();
    const bool is_put = what == "lays" || what == "fills";
    std::string layouts, variants;
    const auto add = [&](std::string_view own, std::string_view layout, std::string_view more) {
      layouts += fmt::format("layout {}_{} {}\n", id, own, layout);
      variants += fmt::format("  {}_{} {{ layout {}_{}{} }}\n", id, own, id, own, more);
    };
    const auto add_table = [&](std::string_view own, std::string table, std::string_view more) {
      const std::string path = fmt::format("starts/{}_{}.csv", id, own);
      add(own, fmt::format("{{ starts \"{}\"; drop none }}", path), more);
      tables.push_back({path, std::move(table)});
    };
    add("moved", fmt::format("like {} {{ jitter 1cm }}", id), "");
    add("shaken", fmt::format("like {} {{ joints jitter 3deg }}", id), "");
    if (is_shown)
      variants +=
          fmt::format("  {}_elsewhere {{ scene {} }}\n", id, shown_elsewhere(task_.written));
    if (is_put) {
      const std::string plain = fmt::format("put the {} {} the {}", name_of_object(roles_.source),
                                            what == "lays" ? "on" : "in", target_name());
      if (plain != task_.instruction)
        variants += fmt::format("  {}_released {{ say \"{}\" }}\n", id, task_.instruction);
      if (!roles_.distractors.empty()) add_table("alone", without_others(), "; distractors none");
      if (const auto other = swapped_with()) add_table("swapped", with_places_of(*other), "");
      if (!foreign.empty()) {
        std::vector<std::string> others = roles_.distractors;
        for (const Foreign& one : foreign) others.push_back(one.what.object);
        add_table("crowded", with_foreign(foreign),
                  fmt::format("; distractors {}", fmt::join(others, ", ")));
      }
    }
    const char* const say = what == "lays"    ? " say lay_put "
                            : what == "fills" ? " say fill_put "
                                              : "";
    return fmt::format("{}task {} like {} {{{}}}\nvariants of {} {{\n{}}}\n\n", layouts, id,
                       task_.written.name, say, id, variants);
  }

 private:
  std::string_view name_of_object(const std::string& name) const {
    const BddlThing* object = problem_.find_object(name);
    return object == nullptr ? std::string_view() : name_of(object->category);
  }

  // The thing whose name says where to put; of a region of an object that object.
  std::string target_thing() const {
    const BddlRegion* region = problem_.find_region(roles_.target);
    return region == nullptr ? roles_.target : region->target;
  }
  std::string_view target_name() const {
    const BddlRegion* region = problem_.find_region(roles_.target);
    const BddlThing* fixture = region == nullptr ? nullptr : problem_.find_fixture(region->target);
    if (fixture == nullptr) return name_of_object(target_thing());
    const std::string_view own = name_of(fixture->category, region->own);
    if (!own.empty()) return own;
    // A region without a name is called like the part whose it is.
    const auto thing = things_.find(fixture->category);
    if (thing == things_.end()) return {};
    const auto known = std::ranges::find(thing->second.regions, region->own, &ThingRegion::name);
    return known == thing->second.regions.end() ? std::string_view()
                                                : name_of(fixture->category, known->part);
  }

  // Whether no other object of the task has its name; a fixture is there once.
  bool is_told_apart(const std::string& name) const {
    const BddlThing* object = problem_.find_object(name);
    return object == nullptr || std::ranges::count_if(problem_.objects, [&](const BddlThing& one) {
                                  return name_of(one.category) == name_of(object->category);
                                }) == 1;
  }

  // ---- tables

  // What a row of the table is about.
  static std::string_view what_of(std::string_view row) {
    const std::size_t from = row.find(',') + 1;
    return row.substr(from, row.find(',', from) - from);
  }

  std::string without_others() const {
    return each_row(task_.written.table, [&](std::string_view row) {
      const bool is_other =
          std::ranges::find(roles_.distractors, what_of(row)) != roles_.distractors.end();
      return is_other ? std::string() : std::string(row);
    });
  }

  // Behind the last row of each start those of what else stands there.
  std::string with_foreign(const std::vector<Foreign>& foreign) const {
    std::string start, out;
    const auto end_start = [&] {
      if (start.empty()) return;
      for (const Foreign& one : foreign)
        out += fmt::format("{},{},{:.4f},{:.4f},{:.4f},{},\n", start, one.what.object, one.x,
                           one.y, one.z, fmt::join(one.what.turn, ","));
    };
    bool is_head = true;
    for_each_row(task_.written.table, [&](std::string_view row) {
      const std::string of(row.substr(0, row.find(',')));
      if (!is_head && of != start) {
        end_start();
        start = of;
      }
      is_head = false;
      out += row;
    });
    end_start();
    return out;
  }

  bool stands_on_workspace(const std::string& name) const {
    return std::ranges::any_of(problem_.init, [&](const BddlFact& fact) {
      if (fact.predicate != "on" || fact.arguments[0] != name) return false;
      const BddlRegion* region = problem_.find_region(fact.arguments[1]);
      return region != nullptr && !region->ranges.empty();
    });
  }

  std::optional<double> radius_of(const std::string& name) const {
    const BddlThing* object = problem_.find_object(name);
    const auto thing = object == nullptr ? things_.end() : things_.find(object->category);
    if (thing == things_.end()) return std::nullopt;
    const Vec3 size = thing->second.high - thing->second.low;
    return size.head<2>().norm() / 2;
  }

  // The thing without a role that is most nearly as wide as the source, where both stand free.
  std::optional<std::string> swapped_with() const {
    constexpr double kAlike = 0.02;  // m: what is wider would stand in its neighbours
    const auto own = radius_of(roles_.source);
    if (!own || !stands_on_workspace(roles_.source)) return std::nullopt;
    std::optional<std::string> best;
    double least = kAlike;
    for (const std::string& other : roles_.distractors) {
      const auto radius = radius_of(other);
      if (!radius || !stands_on_workspace(other) || std::abs(*radius - *own) >= least) continue;
      least = std::abs(*radius - *own);
      best = other;
    }
    return best;
  }

  // Each stands where the other stood, as high and turned as before.
  std::string with_places_of(const std::string& other) const {
    std::map<std::string, std::pair<std::string, std::string>> places;  // by start and thing
    for_each_row(task_.written.table, [&](std::string_view row) {
      const std::vector<std::string> cells = cells_of(row);
      places[cells[kStartCell] + "," + cells[kWhatCell]] = {cells[kXCell], cells[kYCell]};
    });
    return each_row(task_.written.table, [&](std::string_view row) {
      const std::string_view what = what_of(row);
      const bool is_source = what == source_row();
      if (!is_source && what != other) return std::string(row);
      std::vector<std::string> cells = cells_of(row);
      const auto& [x, y] = places.at(cells[kStartCell] + "," + (is_source ? other : source_row()));
      cells[kXCell] = x;
      cells[kYCell] = y;
      return fmt::format("{}", fmt::join(cells, ","));
    });
  }
  static std::string source_row() { return "source"; }

  const AskedTask& task_;
  const BddlProblem& problem_;
  const Things& things_;
  const GoalRoles roles_;
};

}  // namespace

SuiteText write_probing(const std::vector<std::string>& suites, const std::vector<AskedTask>& tasks,
                        const Things& things, const std::set<std::string>& rooms) {
  SuiteText out;
  std::map<std::string_view, std::vector<std::string>> sets;
  for (const std::string_view kind : kKinds) sets[kind];
  for (const std::string_view source : kSources) sets[source];
  for (const PlaceRow& row : kPlaces) sets[row.set];
  sets["twins"];
  std::string body, stages;
  std::set<std::string_view> shown;
  std::map<std::string, Standing> declared;  // those that distract somewhere, as they stand there
  for (const AskedTask& task : tasks) {
    for (const BddlThing& object : task.problem.objects) {
      if (object.name != object.category + "_1" || declared.contains(object.name)) continue;
      if (auto standing = standing_in(task.written.table, object.name))
        declared.emplace(object.name, std::move(*standing));
    }
  }
  std::vector<Standing> objects;
  for (const auto& [name, standing] : declared) objects.push_back(standing);
  std::size_t turn = 0;
  sets["crowded"];
  for (const AskedTask& task : tasks) {
    const TaskAsker asker(task, things);
    const auto place = std::ranges::find(kPlaces, task.written.scene, &PlaceRow::scene);
    const bool is_known = place != std::end(kPlaces);
    const bool is_shown = is_known && rooms.contains(std::string(place->scene)) &&
                          rooms.contains(std::string(place->elsewhere));
    if (is_shown && shown.insert(task.written.stage).second)
      stages += fmt::format("scene {} like {} {{ backdrop \"{}\" }}\n",
                            shown_elsewhere(task.written), task.written.stage, place->elsewhere);
    // From one task to the next others, whatever number they are.
    constexpr std::size_t kStride = 7;
    const std::vector<Foreign> foreign = asker.foreign(objects, kStride * turn++);
    if (!foreign.empty()) sets["crowded"].push_back(task.written.id + "_crowded");
    body += asker.text(out.tables, is_shown, foreign);
    sets[asker.kind()].push_back(task.written.id);
    if (is_known) sets[place->set].push_back(task.written.id);
    if (const std::string_view source = asker.source_set(); !source.empty())
      sets[source].push_back(task.written.id);
    if (asker.has_twins()) sets["twins"].push_back(task.written.id);
  }
  out.text =
      "# The benchmark's tasks asked properly: sorted by what is to be done and where, with starts "
      "of "
      "their own where a question needs them.\n# What is asked stands in "
      "suite/libero/asked.probe.\n";
  for (const std::string& suite : suites) out.text += fmt::format("use \"{}.probe\"\n", suite);
  out.text += "use \"suite/libero/asked.probe\"\n\n";
  if (!stages.empty()) out.text += stages + "\n";
  out.text += body;
  for (const auto& [set, members] : sets)
    out.text += fmt::format("set {} = {{ {} }}\n", set, fmt::join(members, ", "));
  // Here, where those above are seen as well.
  out.text += "set probes = variants of core\n";
  return out;
}

namespace {

struct RepairRow {
  std::string_view rule, repaired;
};
constexpr RepairRow kRepairs[] = {
    {"on_thing", "rests_on_thing"},      {"on_zone", "stands_in_zone"},
    {"on_site", "rests_on_site"},        {"in_site", "lies_in_site"},
    {"drawer_opened", "drawer_is_open"}, {"drawer_closed", "drawer_is_closed"},
    {"door_opened", "door_is_open"},     {"door_closed", "door_is_closed"},
    {"knob_off", "knob_is_off"}};

// Each rule by the one that stands for it: no rule's name is a part of another's.
std::string repaired(std::string goal) {
  for (const RepairRow& row : kRepairs) {
    const std::string call = std::string(row.rule) + "(";
    for (std::size_t at = goal.find(call); at != goal.npos; at = goal.find(call, at)) {
      goal.replace(at, row.rule.size(), row.repaired);
      at += row.repaired.size();
    }
  }
  return goal;
}

}  // namespace

std::string write_clean(const std::vector<std::string>& suites,
                        const std::vector<AskedTask>& tasks) {
  std::string text =
      "# The benchmark's tasks without what its rules let pass: suite/libero/clean.probe has the "
      "rules, suite/libero/README.md what was found.\n";
  for (const std::string& suite : suites) text += fmt::format("use \"{}.probe\"\n", suite);
  text += "use \"suite/libero/clean.probe\"\n\n";
  std::string names;
  for (const AskedTask& task : tasks) {
    const WrittenTask& written = task.written;
    const std::string goal = repaired(written.goal);
    // What lets nothing pass is in the suite as it is.
    if (goal == written.goal) {
      names += (names.empty() ? "" : ", ") + written.name;
      continue;
    }
    text += fmt::format(
        "metrics {}_clean like {} {{ success = at end ({}); ends when {} }}\n"
        "variant {}_clean of {} {{ metrics {}_clean }}\n",
        written.id, written.id, goal, goal, written.id, written.name, written.id);
    names += (names.empty() ? "" : ", ") + written.id + "_clean";
  }
  return text + fmt::format("suite libero_clean {{\n  tasks {{ {} }}\n  seeds 0\n}}\n", names);
}

}  // namespace probe::libero
