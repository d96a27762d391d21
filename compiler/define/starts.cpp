// The ordered enumeration of a layout for the objects of one task, and the shifts of `jitter`.
#include "compiler/define/starts.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <span>

#include "compiler/define/axes.h"
#include "compiler/define/define.h"
#include "compiler/define/fixture.h"
#include "compiler/define/in_start.h"
#include "compiler/define/remembered.h"
#include "compiler/define/role.h"
#include "compiler/define/support.h"
#include "compiler/define/task.h"
#include "compiler/define/views.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/places.h"

namespace probe::sema {
namespace {

// One object to put somewhere, in the order in which the lines name them.
struct Item {
  std::size_t object = 0;  // index into the task's objects
  const Place* place = nullptr;
  std::size_t cells = 0;  // index into layout.cells
  bool has_cells() const {
    return place->how == Place::kDistinct || place->how == Place::kRemaining;
  }
};

struct Enumerator {
  const Model& model;
  const Layout& layout;
  const Task& task;
  std::vector<ObjectId> objects;
  std::vector<Item> items;
  std::vector<std::vector<Turn>> turns;  // by object
  std::size_t turn_count = 1;

  std::optional<std::size_t> index_of(ObjectId object) const {
    const auto at = std::find(objects.begin(), objects.end(), object);
    if (at == objects.end()) return std::nullopt;
    return static_cast<std::size_t>(at - objects.begin());
  }

  bool is_distractor(ObjectId object) const {
    return std::find(task.distractors.begin(), task.distractors.end(), object) !=
           task.distractors.end();
  }

  // Whether a line places the object by its own name, wherever its role is placed.
  bool has_own_place(ObjectId object) const {
    return std::ranges::any_of(layout.places, [&](const Place& place) {
      return std::ranges::any_of(place.what, [&](const Spelled& word) {
        return word.text == model.objects[object].name && !find_role(model, word.text);
      });
    });
  }

  // The task's objects that a line's word means; an object that is not in the task is nothing.
  std::vector<std::size_t> meant(const Spelled& word) const {
    std::vector<std::size_t> result;
    const auto role = find_role(model, word.text);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const bool by_role = role ? task.role_of(objects[i]) == *role
                                : word.text == "distractors" && is_distractor(objects[i]);
      if (by_role || (!role && model.objects[objects[i]].name == word.text)) result.push_back(i);
    }
    return result;
  }

  std::optional<LayoutProblem> plan_items() {
    std::vector<bool> placed(objects.size(), false);
    for (const Place& place : layout.places) {
      std::size_t cells = 0;
      while (cells < layout.cells.size() && layout.cells[cells].name != place.cells) ++cells;
      for (const Spelled& word : place.what) {
        for (const std::size_t object : meant(word)) {
          const bool by_name = model.objects[objects[object]].name == word.text;
          if (placed[object] || (!by_name && has_own_place(objects[object]))) continue;
          placed[object] = true;
          items.push_back({object, &place, cells});
        }
      }
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (placed[i]) continue;
      return LayoutProblem{
          Situation::kNotPlaced,
          "layout `" + layout.name + "` places no `" + model.objects[objects[i]].name + "`",
          layout.span, "the layout", place_advice(objects[i])};
    }
    return std::nullopt;
  }

  // The line that places it, by its role where it has one: a copy of the layout may stand beside it.
  std::string place_advice(ObjectId id) const {
    const RoleId role = task.role_of(id);
    const bool is_distractor = std::ranges::find(task.distractors, id) != task.distractors.end();
    const std::string& name = role != RoleId::kNone ? model.roles[role].name : model.objects[id].name;
    return "write `place " + (is_distractor ? std::string("distractors") : name) +
           " at (X, Y)` there, or in a copy: `layout NAME like " + layout.name + " { place " +
           (is_distractor ? "distractors in remaining CELLS" : name + " at (X, Y)") + " }`";
  }

  std::optional<LayoutProblem> plan_turns() {
    for (const ObjectId object : objects) {
      std::vector<Turn> rest = rest_of(model, task, object);
      if (!layout.by_rest && rest.size() > 1) rest.resize(1);
      turns.push_back(std::move(rest));
    }
    for (const Orient& orient : layout.orients) {
      for (const std::size_t object : meant(orient.what)) turns[object] = orient.turns;
    }
    if (objects.empty()) return std::nullopt;  // a fixture alone: one start
    std::size_t longest = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (turns[i].size() > turns[longest].size()) longest = i;
    }
    turn_count = turns[longest].size();
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (turns[i].size() == turn_count || turns[i].size() == 1) continue;
      return LayoutProblem{Situation::kTurnsOutOfStep,
                           "`" + model.objects[objects[longest]].name + "` has " +
                               std::to_string(turn_count) + " turns and `" +
                               model.objects[objects[i]].name + "` has " +
                               std::to_string(turns[i].size()),
                           layout.span};
    }
    return std::nullopt;
  }

  // How many starts placements() makes with these grids; a double, so that nothing overflows.
  double count(const std::vector<std::size_t>& grids) const {
    double ways = static_cast<double>(turn_count);
    std::vector<std::size_t> used(layout.cells.size(), 0);
    for (const Item& item : items) {
      if (!item.has_cells()) continue;
      const std::size_t size = layout.cells[item.cells].grids[grids[item.cells]].size();
      const std::size_t left = size - std::min(size, used[item.cells]++);
      ways *= item.place->how == Place::kDistinct ? static_cast<double>(left) : left > 0 ? 1 : 0;
    }
    return ways;
  }

  // All ways to give the items their cells, as one odometer: the digit of a `distinct` item is its
  // cell, later items fastest; the others have one way. `grids` chooses a grid for each named set
  // of cells.
  void placements(const std::vector<std::size_t>& grids, std::vector<Start>& out) const {
    std::vector<std::size_t> digit(items.size(), 0);
    std::size_t depth = 0;
    bool fresh = true;
    while (true) {
      if (depth == items.size()) {
        emit(grids, digit, out);
        if (depth == 0) return;
        --depth;
        fresh = false;
        continue;
      }
      const Item& item = items[depth];
      const bool has_cells = item.has_cells();
      const std::size_t count =
          has_cells ? layout.cells[item.cells].grids[grids[item.cells]].size() : 1;
      std::size_t next = fresh ? 0 : digit[depth] + 1;
      if (item.place->how == Place::kRemaining && !fresh) next = count;
      while (has_cells && next < count && is_taken(digit, depth, next)) ++next;
      if (next >= count) {
        if (depth == 0) return;
        --depth;
        fresh = false;
        continue;
      }
      digit[depth] = next;
      ++depth;
      fresh = true;
    }
  }

  bool is_taken(const std::vector<std::size_t>& digit, std::size_t depth, std::size_t cell) const {
    for (std::size_t i = 0; i < depth; ++i) {
      if (items[i].has_cells() && items[i].cells == items[depth].cells && digit[i] == cell)
        return true;
    }
    return false;
  }

  void emit(const std::vector<std::size_t>& grids, const std::vector<std::size_t>& digit,
            std::vector<Start>& out) const {
    Start start;
    start.placed.resize(objects.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Item& item = items[i];
      // What is put in or on something gets its place when that has one.
      const Cell cell = !item.has_cells()
                            ? item.place->at
                            : layout.cells[item.cells].grids[grids[item.cells]][digit[i]];
      start.placed[item.object] = {objects[item.object], cell.x, cell.y, {}};
    }
    for (std::size_t turn = 0; turn < turn_count; ++turn) {
      for (std::size_t i = 0; i < objects.size(); ++i) {
        start.placed[i].turn = turns[i].size() == 1 ? turns[i][0] : turns[i][turn];
      }
      out.push_back(start);
    }
  }
};

// Whether a row is an object's: it has its name, or that of its role, or is that of the distractors
// of a task that has one.
bool is_row_of(const Model& model, const Task& task, const std::string& row, ObjectId id) {
  if (const auto role = find_role(model, row)) return task.role_of(id) == *role;
  if (row == "distractors") return task.distractors == std::vector<ObjectId>{id};
  return row == model.objects[id].name;
}

// The starts of a file, for the objects of one task. A row that is no object's of it is none of
// its: a role or the distractors that it takes away.
std::vector<Start> given_starts(const Model& model, const Layout& layout, const Task& task,
                                std::optional<LayoutProblem>& problem) {
  const std::vector<ObjectId> objects = task.objects();
  std::vector<Start> starts;
  for (const std::vector<GivenPlace>& given : layout.given) {
    Start start;
    start.given = starts.size();
    for (const ObjectId id : objects) {
      const Object& object = model.objects[id];
      const std::string in_start =
          "start " + std::to_string(starts.size()) + " of layout `" + layout.name + "` ";
      const GivenPlace* found = nullptr;
      for (const GivenPlace& place : given) {
        if (!is_row_of(model, task, place.what.text, id)) continue;
        if (found != nullptr) {
          problem = LayoutProblem{Situation::kStartTwice,
                                  in_start + "has `" + object.name + "` twice, as `" +
                                      found->what.text + "` and `" + place.what.text + "`,",
                                  place.what.span, "the second"};
          return {};
        }
        found = &place;
      }
      if (found == nullptr) {
        problem =
            LayoutProblem{Situation::kStartLacks, in_start + "has no `" + object.name + "`",
                          given.empty() ? layout.given_span : given.front().what.span, "the start"};
        return {};
      }
      const std::vector<Turn> rest = rest_of(model, task, id);
      const bool is_posed = std::any_of(task.poses.begin(), task.poses.end(),
                                        [&](const PoseOverride& p) { return p.object == id; });
      if (is_posed && rest.size() > 1) {
        problem = LayoutProblem{Situation::kTurnsOutOfStep,
                                "`" + object.name + "` has " + std::to_string(rest.size()) +
                                    " turns and a start of layout `" + layout.name + "` one",
                                layout.given_span};
        return {};
      }
      Start::Placed placed{id, found->x, found->y, {}, found->z};
      if (found->rotation && !is_posed) {
        placed.turn.rotation = *found->rotation;
      } else if (!rest.empty()) {
        placed.turn = rest.front();
      }
      start.placed.push_back(placed);
    }
    starts.push_back(std::move(start));
  }
  return starts;
}

// A number in [-1, 1) from the first bits of a hash.
double draw(const Sha256& hash) {
  return static_cast<double>(big_endian_number(hash) >> 11) * 0x1p-52 - 1.0;
}

// Every draw has its own key, the number of the start with the object's name and the axis: no other
// task or object shifts it, whatever else stands in the scene.
// What is put in or on something goes with it.
void jitter(const Model& model, double most, std::size_t index, const std::vector<Put>& puts,
            Start& start) {
  for (Start::Placed& placed : start.placed) {
    const auto is_put = [&](const Put& put) { return put.object == placed.object; };
    if (std::ranges::any_of(puts, is_put)) continue;
    double* const axes[] = {&placed.x, &placed.y};
    for (std::uint8_t axis = 0; axis < 2; ++axis) {
      Hasher hasher;
      hasher.text("jitter").u64(index).text(model.objects[placed.object].name).u8(axis);
      *axes[axis] += most * draw(hasher.finish());
    }
  }
}

// All that cells, places and turns give.
std::vector<Start> all_ways(const Model& model, const Layout& layout, const Task& task,
                            std::size_t most, std::vector<Put>& puts,
                            std::optional<LayoutProblem>& problem) {
  Enumerator enumerator{model, layout, task, task.objects(), {}, {}, 1};
  problem = enumerator.plan_items();
  if (!problem) problem = enumerator.plan_turns();
  if (problem) return {};
  for (const Item& item : enumerator.items) {
    if (item.place->is_put()) puts.push_back({enumerator.objects[item.object], item.place});
  }
  std::vector<Start> starts;
  std::vector<std::size_t> grids(layout.cells.size(), 0);
  double count = 0;
  while (true) {
    count += enumerator.count(grids);
    if (count > static_cast<double>(most)) {
      problem = LayoutProblem{Situation::kTooManyEpisodes,
                              "the suite grows beyond " + std::to_string(kMaxEpisodes) +
                                  " episodes with layout `" + layout.name + "`",
                              layout.span};
      return {};
    }
    enumerator.placements(grids, starts);
    std::size_t at = grids.size();
    while (at > 0 && grids[at - 1] + 1 >= layout.cells[at - 1].grids.size()) grids[--at] = 0;
    if (at == 0) break;
    ++grids[at - 1];
  }
  if (starts.empty()) {
    std::size_t cells = 0;
    Span span = layout.span;
    for (const Item& item : enumerator.items) {
      if (!item.has_cells()) continue;
      cells = layout.cells[item.cells].grids.front().size();
      span = item.place->span;
    }
    problem = LayoutProblem{Situation::kTooFewCells,
                            std::to_string(enumerator.objects.size()) + " objects for " +
                                std::to_string(cells) + " cells",
                            span};
  }
  return starts;
}

}  // namespace

const GivenPlace* row_of(const Model& model, const Layout& layout, const Task& task,
                         const Start& start, ObjectId id) {
  if (start.given >= layout.given.size()) return nullptr;
  for (const GivenPlace& place : layout.given[start.given]) {
    if (is_row_of(model, task, place.what.text, id)) return &place;
  }
  return nullptr;
}

std::vector<Start> enumerate_starts(Supports& supports, const Model& model, const Layout& layout,
                                    const Task& task, std::size_t most,
                                    std::optional<LayoutProblem>& problem) {
  std::vector<Put> puts;
  std::vector<Start> starts = layout.given_span.is_none()
                                  ? all_ways(model, layout, task, most, puts, problem)
                                  : given_starts(model, layout, task, problem);
  if (layout.jitter > 0) {
    for (std::size_t i = 0; i < starts.size(); ++i)
      jitter(model, layout.jitter, i, puts, starts[i]);
  }
  if (puts.empty()) return starts;
  for (Start& start : starts) {
    problem = supports.stack(layout, task, puts, start);
    if (problem) return {};
  }
  return starts;
}

namespace {

// What the starts of a task depend on.
std::vector<double> starts_key(const Model& model, const Task& task) {
  std::vector<double> key = {static_cast<double>(task.layout)};
  // Layouts place by role, so equal objects in other roles lie elsewhere.
  for (const ObjectId id : task.objects()) {
    key.push_back(static_cast<double>(id));
    key.push_back(static_cast<double>(task.role_of(id)));
  }
  for (const PoseOverride& pose : task.poses) {
    key.push_back(-1);
    key.push_back(static_cast<double>(pose.object));
    for (const Turn& turn : pose.turns)
      key.insert(key.end(), turn.rotation.begin(), turn.rotation.end());
  }
  // What is put into something depends on where that is and on what fills its role.
  const Layout& layout = model.layouts[task.layout];
  if (std::ranges::any_of(layout.places, [](const Place& place) { return place.is_put(); })) {
    key.push_back(-3);
    key.push_back(static_cast<double>(task.scene));
    for (const auto& [role, thing] : task.things()) {
      key.push_back(static_cast<double>(role));
      key.push_back(static_cast<double>(thing));
    }
    const std::vector<double> joints = joint_starts_of(model, task);
    key.insert(key.end(), joints.begin(), joints.end());
  }
  // What a phrase denotes depends on the camera, too.
  if (!task.clear.empty()) {
    key.push_back(-2);
    key.push_back(static_cast<double>(task.scene));
    key.push_back(static_cast<double>(views_of(model, task).front().camera));
    for (const ClearPhrase& clear : task.clear) {
      key.push_back(static_cast<double>(clear.role));
      const ObjectId object = task.objects_in(clear.role).front();
      const auto& phrases = model.objects[object].phrases;
      key.push_back(static_cast<double>(model.objects[object].find_phrase(clear.phrase.text) -
                                        phrases.data()));
    }
  }
  return key;
}

void report_problem(Context& context, const Task& task, const LayoutProblem& problem) {
  // Where the layout is fine for the task that this one copies, what came in here is to blame.
  const bool like_is_fine =
      task.like != TaskId::kNone && !context.model.tasks[task.like].starts.empty();
  const bool is_newcomer = like_is_fine && is_within(task.distractors_span, task.decl_span);
  Diagnostic& said =
      context.report(problem.what, is_newcomer ? task.distractors_span : task.layout_span,
                     problem.message + " in `" + task.name + "`");
  said.label(problem.span, std::string(problem.label));
  if (problem.what == Situation::kStartLacks)
    said.help("each start of the table has a row for every object of the task, by its name or its role");
  if (!problem.advice.empty()) said.help(problem.advice);
}

}  // namespace

std::vector<Start> clear_starts(Relations& relations, const Model& model, const Task& task,
                                std::vector<Start> starts) {
  for (const ClearPhrase& clear : task.clear) {
    const ObjectId object = task.objects_in(clear.role).front();
    const Phrase& phrase = *model.objects[object].find_phrase(clear.phrase.text);
    std::erase_if(starts, [&](const Start& start) {
      return !InStart(relations, task, start).denote(phrase, object).is_clear();
    });
  }
  return starts;
}

namespace {

// "(7.5cm, 0cm)"
std::string place_text(const Start::Placed& placed) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.4gcm, %.4gcm)", placed.x * 100, placed.y * 100);
  return text;
}

// Why a task has no start in which its phrases are clear: what each of them comes to in all starts,
// and where things are in one of them.
void report_unclear(Context& context, Relations& relations, const Task& task,
                    const std::vector<Start>& starts) {
  const Model& model = context.model;
  Diagnostic& said =
      context.report(Code::P0402, task.clear.back().phrase.span,
                     "none of the " + std::to_string(starts.size()) + " starts of `" + task.name +
                         "` has clear phrases");
  for (const ClearPhrase& clear : task.clear) {
    const ObjectId wanted = task.objects_in(clear.role).front();
    const Phrase& phrase = *model.objects[wanted].find_phrase(clear.phrase.text);
    std::size_t wrong = 0, others = 0, close = 0;
    for (const Start& start : starts) {
      const Denotation meant = InStart(relations, task, start).denote(phrase, wanted);
      if (meant.is_clear()) continue;
      // As the checks of phrases weigh them: what is false is false whatever else is meant.
      ++(!meant.may_fit ? wrong : !meant.sure.empty() ? others : close);
    }
    const std::string of = " of " + std::to_string(starts.size()) + " starts";
    std::string sum;
    const auto add = [&](std::size_t count, const std::string& what) {
      if (count > 0)
        sum += (sum.empty() ? "" : ", ") + std::to_string(count) + (sum.empty() ? of : "") + what;
    };
    add(wrong, " are not so of `" + model.objects[wanted].name + "`");
    add(others, " are so of another thing, too");
    const std::string unsaid = close > 0 ? unsaid_in(model, task, phrase) : "";
    add(close,
        unsaid.empty()
            ? " are too close to call, as things come to rest a little beside where they are put"
            : " cannot be told");
    if (!sum.empty()) said.note("\"" + phrase.text.text + "\": " + sum);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const Denotation meant = InStart(relations, task, starts[i]).denote(phrase, wanted);
      if (meant.sure.empty()) continue;
      std::string names;
      for (const ObjectId id : meant.sure)
        names += (names.empty() ? "`" : ", `") + model.objects[id].name + "`";
      said.note("in start " + std::to_string(i) + " it denotes " + names +
                (meant.fits ? ", too" : ""));
      break;
    }
    if (!unsaid.empty()) said.note(unsaid);
  }
  std::string places;
  for (const Start::Placed& placed : starts.front().placed)
    places += (places.empty() ? "" : ", ") + model.objects[placed.object].name + " at " + place_text(placed);
  said.note("start 0: " + places);
}

// What differs by the choice of phrases can be told only now.
void compare_choices(Model& model) {
  for (Task& task : model.tasks) {
    if (task.baseline == TaskId::kNone) continue;
    const Task& baseline = model.tasks[task.baseline];
    if (!task.complete || !baseline.complete) continue;  // reported
    if (task.clear.empty() && baseline.clear.empty()) continue;
    task.axes = axes_between(model, task, baseline);
  }
}

// What fills roles and what the layout placed by name: distractors, between the two, are left out.
std::vector<Start::Placed> standing(const Task& task, const Start& start) {
  std::vector<Start::Placed> all = start.placed;
  const auto first =
      all.begin() + static_cast<std::ptrdiff_t>(std::min(roles_filled(task), all.size()));
  const auto count =
      std::min(static_cast<std::ptrdiff_t>(task.distractors.size()), all.end() - first);
  all.erase(first, first + count);
  return all;
}

std::vector<plan::Place> places_of(std::span<const Start::Placed> placed) {
  std::vector<plan::Place> places;
  for (const Start::Placed& one : placed) places.push_back(plan::place_at(one.x, one.y));
  return places;
}

std::vector<plan::Place> places_taken(const Task& task, const Start& start) {
  std::vector<plan::Place> places = places_of(standing(task, start));
  std::sort(places.begin(), places.end());
  return places;
}

std::vector<plan::Place> places_in_roles(const Task& task, const Start& start) {
  return places_of(
      std::span(start.placed).first(std::min(roles_filled(task), start.placed.size())));
}

const Start::Placed* find_placed(const Start& start, ObjectId object) {
  const auto found = std::ranges::find(start.placed, object, &Start::Placed::object);
  return found == start.placed.end() ? nullptr : &*found;
}

// Whether all that stands in one start lies there in the other, too, as far as it is in it; where
// it is not, what fills its role there. Distractors alone may have moved.
bool stand_there(const Task& a, const Start& here, const Task& b, const Start& there) {
  const std::size_t shared = std::min(roles_filled(a), roles_filled(b));
  const std::vector<Start::Placed> all = standing(a, here);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Start::Placed* other = find_placed(there, all[i].object);
    if (other == nullptr && i < shared && find_placed(here, there.placed[i].object) == nullptr)
      other = &there.placed[i];
    if (other != nullptr &&
        plan::place_at(all[i].x, all[i].y) != plan::place_at(other->x, other->y))
      return false;
  }
  return true;
}

}  // namespace

std::size_t roles_filled(const Task& task) {
  return task.objects().size() - task.distractors.size() - task.placed.size();
}

bool start_at_same_places(const Task& a, const Task& b) {
  return std::ranges::equal(a.starts, b.starts, [&](const Start& p, const Start& q) {
    return stand_there(a, p, b, q) && stand_there(b, q, a, p);
  });
}

bool starts_correspond(const Task& a, const Task& b) {
  return a.scene == b.scene &&
         std::ranges::equal(a.starts, b.starts, [&](const Start& p, const Start& q) {
           return places_in_roles(a, p) == places_in_roles(b, q) ||
                  places_taken(a, p) == places_taken(b, q);
         });
}

namespace {

// Whether nothing but declarations and numbers says where its things are: no phrase, and nothing in
// or on another.
bool is_told_by_numbers(const Model& model, const Task& task) {
  return task.clear.empty() &&
         std::ranges::none_of(model.layouts[task.layout].places, &Place::is_put);
}

}  // namespace

void define_starts(Context& context) {
  Model& model = context.model;
  struct Listed {
    const std::vector<Start>* starts = nullptr;
    std::size_t of = 0;
  };
  std::map<std::vector<double>, Listed> known;
  std::set<LayoutId> incomplete_layouts;  // that lack a place: said once
  std::set<std::vector<double>> unclear;  // starts that no phrase is clear in: said once
  Relations relations(model, context.asset_root, context.diagnostics);
  Supports supports(model, context.asset_root);
  std::size_t episodes = 0;
  for (Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    const About about(context.reporter, task.decl_span);
    const std::vector<double> made_of = starts_key(model, task);
    Listed& listed = known[made_of];
    if (listed.starts == nullptr) {
      const Layout& layout = model.layouts[task.layout];
      std::optional<LayoutProblem> problem;
      // Where nothing but what is declared, and by number, says where things are.
      Remembered* const remembered =
          is_told_by_numbers(model, task) ? context.reporter.depth.remembered : nullptr;
      const std::vector<Start>* const before = remembered ? remembered->starts(task.layout, made_of) : nullptr;
      const std::size_t most = kMaxEpisodes - episodes;
      std::vector<Start> found = before != nullptr && before->size() <= most
                                     ? *before
                                     : enumerate_starts(supports, model, layout, task, most, problem);
      if (remembered != nullptr && before == nullptr && !problem)
        remembered->keep_starts(task.layout, made_of, found);
      // A file that could not be read has been reported.
      if (!layout.given_span.is_none() && layout.given.empty()) continue;
      if (problem) {
        // What a layout lacks, its copies lack.
        const bool is_known = incomplete_layouts.contains(layout.like);
        const bool is_layout = problem->what == Situation::kNotPlaced;
        if (is_layout && (!incomplete_layouts.insert(task.layout).second || is_known)) continue;
        report_problem(context, task, *problem);
        continue;
      }
      listed.of = found.size();
      if (!task.clear.empty()) {
        std::vector<Start> clear = clear_starts(relations, model, task, found);
        if (clear.empty()) {
          // What one of several that are alike lacks, all do.
          if (unclear.insert(starts_key(model, task)).second)
            report_unclear(context, relations, task, found);
          continue;
        }
        found = std::move(clear);
      }
      listed.starts = &model.start_lists.emplace_back(std::move(found));
    }
    task.starts = *listed.starts;
    task.layout_starts = listed.of;
    episodes += task.starts.size();
    if (episodes <= kMaxEpisodes) continue;
    context.report(Situation::kTooManyEpisodes, task.span,
                   "the suite grows beyond " + std::to_string(kMaxEpisodes) + " episodes with `" +
                       task.name + "`");
    return;
  }
  compare_choices(model);
}

}  // namespace probe::sema
