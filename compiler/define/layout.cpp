#include "compiler/define/layout.h"

#include <algorithm>

#include "compiler/define/passes.h"
#include "compiler/define/task.h"
#include "runtime/base/sha256.h"

namespace probe::sema {
namespace {

// ---- reading
// --------------------------------------------------------------------------------------------------------

// centre - spread + 2 spread i / (n - 1), in exact decimals wherever the result is one, rounded
// once.
double grid_coordinate(const Decimal& centre, const Decimal& spread, std::uint64_t i,
                       std::uint64_t n) {
  if (n == 1) return centre.to_double();
  const int steps = static_cast<int>(n - 1);
  const Decimal sum = centre * steps + spread * (2 * static_cast<int>(i) - steps);
  // A few more decimal places turn a half, a quarter or a fifth of a step into a decimal too.
  Decimal finer = sum;
  for (int digits = 0; digits < 4; ++digits, finer.mantissa *= 10, --finer.exponent) {
    if (finer.mantissa % steps == 0)
      return Decimal{finer.mantissa / steps, finer.exponent}.to_double();
  }
  // A third of a step is no decimal: round the numerator and the quotient.
  return sum.to_double() / steps;
}

struct LayoutReader {
  Context& context;
  Layout& layout;
  bool has_orient = false;

  void operator()(const syntax::CellsStmt& stmt) {
    Cells cells{std::string(stmt.name.text), stmt.span, {}, {}};
    const auto at = read_point(context, stmt.at, 2, 2, dim::kLength, "`grid ... at` takes lengths");
    const bool fits =
        stmt.nx.value >= 1 && stmt.ny.value >= 1 && stmt.nx.value <= 1000 && stmt.ny.value <= 1000;
    if (!fits)
      context.report(Code::P0304, join(stmt.nx.span, stmt.ny.span),
                     "expected 1 to 1000 cells a side");
    for (const syntax::Point& point : stmt.spreads) {
      const auto spread = read_point(context, point, 2, 2, dim::kLength, "`spread` takes lengths");
      if (!spread || !at || !fits) continue;
      const auto is_flat = [&](std::size_t axis, std::uint64_t side) {
        return side > 1 && (*spread)[axis].si() == 0;
      };
      if (is_flat(0, stmt.nx.value) || is_flat(1, stmt.ny.value)) {
        context.report(Code::P0304, point.span, "cells of one row lie in the same place")
            .help("a side of more than one cell needs a spread");
        continue;
      }
      std::vector<Cell> grid;
      for (std::uint64_t i = 0; i < stmt.nx.value; ++i) {
        for (std::uint64_t j = 0; j < stmt.ny.value; ++j) {
          grid.push_back({grid_coordinate((*at)[0].exact, (*spread)[0].exact, i, stmt.nx.value),
                          grid_coordinate((*at)[1].exact, (*spread)[1].exact, j, stmt.ny.value)});
        }
      }
      cells.grids.push_back(std::move(grid));
      cells.spreads.push_back({(*spread)[0].si(), (*spread)[1].si(), point.span});
    }
    for (Cells& known : layout.cells) {
      if (known.name != cells.name) continue;
      known = std::move(cells);
      return;
    }
    layout.cells.push_back(std::move(cells));
  }

  // A copied line for one of the same names is replaced where it stood, so that its speed stays.
  void place(Place place) {
    for (Place& known : layout.places) {
      const bool same = std::any_of(known.what.begin(), known.what.end(), [&](const Spelled& old) {
        return std::any_of(place.what.begin(), place.what.end(),
                           [&](const Spelled& now) { return now.text == old.text; });
      });
      if (!same) continue;
      known = std::move(place);
      return;
    }
    layout.places.push_back(std::move(place));
  }
  std::vector<Spelled> placed_names(const std::vector<syntax::Name>& names) {
    std::vector<Spelled> result;
    for (const syntax::Name& name : names) {
      const bool is_role =
          name.text == "source" || name.text == "target" || name.text == "distractors";
      if (!is_role && !context.symbols.objects.find(name, context.diagnostics)) continue;
      result.push_back(spelled(name));
    }
    return result;
  }
  void operator()(const syntax::PlaceAtStmt& stmt) {
    Place record;
    record.span = stmt.span;
    record.what = placed_names(stmt.names);
    if (const auto at =
            read_point(context, stmt.at, 2, 2, dim::kLength, "`place ... at` takes lengths")) {
      record.at = {(*at)[0].si(), (*at)[1].si()};
    }
    place(std::move(record));
  }
  void operator()(const syntax::PlaceInStmt& stmt) {
    Place record;
    record.span = stmt.span;
    record.how = stmt.how == syntax::PlaceHow::kDistinct ? Place::kDistinct : Place::kRemaining;
    record.what = placed_names(stmt.names);
    record.cells = std::string(stmt.cells.text);
    std::vector<std::string_view> known;
    for (const Cells& cells : layout.cells) known.push_back(cells.name);
    if (std::find(known.begin(), known.end(), stmt.cells.text) == known.end()) {
      report_unknown(context.diagnostics, "cells", stmt.cells, known);
      return;
    }
    place(std::move(record));
  }
  void begin_orient() {
    if (has_orient) return;
    has_orient = true;
    layout.by_rest = false;
    layout.orients.clear();
  }
  void operator()(const syntax::OrientByRestStmt&) {
    begin_orient();
    layout.by_rest = true;
  }
  void operator()(const syntax::OrientStmt& stmt) {
    begin_orient();
    if (stmt.what.text != "source" && stmt.what.text != "target" &&
        stmt.what.text != "distractors" &&
        !context.symbols.objects.find(stmt.what, context.diagnostics)) {
      return;
    }
    if (const auto turns = read_turns(context, stmt.poses))
      layout.orients.push_back({spelled(stmt.what), *turns});
  }
  void operator()(const syntax::JitterStmt& stmt) {
    layout.jitter =
        read_si(context, stmt.value, dim::kLength, "`jitter` takes a length").value_or(0);
    layout.jitter_span = stmt.value.span;
    if (layout.jitter >= 0) return;
    context.report(Code::P0304, stmt.value.span, "expected a jitter of 0 or more");
    layout.jitter = 0;
  }
  void operator()(const syntax::DropStmt& stmt) {
    layout.has_drop = true;
    layout.drop = read_si(context, stmt.height, dim::kLength, "`drop` takes a height").value_or(0);
    if (layout.drop < 0)
      context.report(Code::P0304, stmt.height.span, "objects are dropped from above the surface");
    if (!stmt.settle) return;
    // A phase of the drop; a minute is far beyond what any object needs and still quick to
    // simulate.
    constexpr double kLongestSettle = 60;
    layout.settle =
        read_positive(context, *stmt.settle, dim::kTime, "`settle` takes a time").value_or(1);
    if (layout.settle > kLongestSettle)
      context.report(Code::P0304, stmt.settle->span,
                     "expected at most 60s to settle, found `" +
                         std::string(context.sources.text(stmt.settle->span)) + "`");
  }
  void operator()(const syntax::ExpectEpisodesStmt& stmt) {
    layout.expect = stmt.episodes.value;
    layout.expect_span = stmt.span;
  }
};

// ---- enumeration
// ----------------------------------------------------------------------------------------------------

// One object to put somewhere, in the order in which the lines name them.
struct Item {
  std::size_t object = 0;  // index into the task's objects
  const Place* place = nullptr;
  std::size_t cells = 0;  // index into layout.cells
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

  // The task's objects that a line's word means; an object that is not in the task is nothing.
  std::vector<std::size_t> meant(const Spelled& word) const {
    if (word.text == "source") return {0};
    if (word.text == "target") return {1};
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const bool by_role = word.text == "distractors" && i >= 2;
      if (by_role || model.objects[objects[i]].name == word.text) result.push_back(i);
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
          if (placed[object]) continue;
          placed[object] = true;
          items.push_back({object, &place, cells});
        }
      }
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (placed[i]) continue;
      return LayoutProblem{
          LayoutProblem::kNotPlaced,
          "layout `" + layout.name + "` places no `" + model.objects[objects[i]].name + "`",
          layout.span};
    }
    return std::nullopt;
  }

  std::vector<Turn> rest_of(ObjectId object) const {
    for (const PoseOverride& pose : task.poses) {
      if (pose.object == object) return pose.turns;
    }
    return model.objects[object].rest;
  }

  std::optional<LayoutProblem> plan_turns() {
    for (const ObjectId object : objects) {
      std::vector<Turn> rest = rest_of(object);
      if (!layout.by_rest && rest.size() > 1) rest.resize(1);
      turns.push_back(std::move(rest));
    }
    for (const Orient& orient : layout.orients) {
      for (const std::size_t object : meant(orient.what)) turns[object] = orient.turns;
    }
    std::size_t longest = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (turns[i].size() > turns[longest].size()) longest = i;
    }
    turn_count = turns[longest].size();
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (turns[i].size() == turn_count || turns[i].size() == 1) continue;
      return LayoutProblem{LayoutProblem::kRestCount,
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
      if (item.place->how == Place::kAt) continue;
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
      const bool has_cells = item.place->how != Place::kAt;
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
      if (items[i].place->how != Place::kAt && items[i].cells == items[depth].cells &&
          digit[i] == cell)
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
      const Cell cell = item.place->how == Place::kAt
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

// A number in [-1, 1) from the first bits of a hash.
double draw(const Sha256& hash) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits = bits << 8 | hash.bytes[i];
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
}

// Every draw has its own key, the start as the grid gives it with the object and the axis, so that
// no other task, start or object shifts it.
void jitter(const Model& model, double most, Start& start) {
  std::vector<std::pair<std::string, const Start::Placed*>> rows;
  for (const Start::Placed& placed : start.placed)
    rows.emplace_back(model.objects[placed.object].name, &placed);
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  Hasher whole;
  whole.text("start");
  for (const auto& [name, placed] : rows)
    whole.text(name).f64(placed->x).f64(placed->y).f64s(placed->turn.rotation);
  const Sha256 key = whole.finish();
  for (Start::Placed& placed : start.placed) {
    double* const axes[] = {&placed.x, &placed.y};
    for (std::uint8_t axis = 0; axis < 2; ++axis) {
      Hasher hasher;
      hasher.text("jitter").hash(key).text(model.objects[placed.object].name).u8(axis);
      *axes[axis] += most * draw(hasher.finish());
    }
  }
}

}  // namespace

std::vector<Start> enumerate_starts(const Model& model, const Layout& layout, const Task& task,
                                    std::size_t most, std::optional<LayoutProblem>& problem) {
  Enumerator enumerator{model, layout, task, task.objects(), {}, {}, 1};
  problem = enumerator.plan_items();
  if (!problem) problem = enumerator.plan_turns();
  if (problem) return {};
  std::vector<Start> starts;
  std::vector<std::size_t> grids(layout.cells.size(), 0);
  double count = 0;
  while (true) {
    count += enumerator.count(grids);
    if (count > static_cast<double>(most)) {
      problem = LayoutProblem{LayoutProblem::kTooMany,
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
      if (item.place->how == Place::kAt) continue;
      cells = layout.cells[item.cells].grids.front().size();
      span = item.place->span;
    }
    problem = LayoutProblem{LayoutProblem::kTooFewCells,
                            std::to_string(enumerator.objects.size()) + " objects for " +
                                std::to_string(cells) + " cells",
                            span};
  }
  if (layout.jitter > 0) {
    for (Start& start : starts) jitter(model, layout.jitter, start);
  }
  return starts;
}

namespace {

// Objects are put down before an episode and judged when they lie still.
void require_rest(Context& context, const Layout& layout) {
  if (!layout.has_drop) {
    context.report(Code::P0206, layout.span, "layout `" + layout.name + "` has no `drop`")
        .help("write how objects are put down, such as `drop 50cm settle 0.5s`");
  } else if (layout.settle == 0) {
    context.report(Code::P0206, layout.span, "layout `" + layout.name + "` has no `settle`")
        .help("without time to come to rest, such as `settle 0.5s`, objects are judged in the air");
  }
}

}  // namespace

void define_layouts(Context& context) {
  const auto& decls = context.symbols.layout_decls;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  std::vector<bool> broken(decls.size(), false);  // reported; what it lacks follows from that
  for (std::size_t i = 0; i < decls.size(); ++i) {
    context.model.layouts.add({});
    if (decls[i].node->like)
      parents[i] = context.symbols.layouts.find(*decls[i].node->like, context.diagnostics);
  }
  for (const std::uint32_t i : parents_first(context, parents, context.symbols.layouts.names())) {
    const syntax::LayoutDecl& node = *decls[i].node;
    Layout layout;
    if (parents[i]) layout = context.model.layouts[static_cast<LayoutId>(*parents[i])];
    if (parents[i]) layout.like = static_cast<LayoutId>(*parents[i]);
    layout.name = std::string(node.name.text);
    layout.span = node.name.span;
    const auto errors = context.mistakes();
    LayoutReader reader{context, layout};
    for (const syntax::LayoutStmt& stmt : node.body) std::visit(reader, stmt);
    // A grid that could not be read has been reported; one cell keeps the enumeration going.
    for (Cells& cells : layout.cells) {
      if (!cells.grids.empty()) continue;
      cells.grids.push_back({{}});
      cells.spreads.push_back({});
    }
    broken[i] = !decls[i].decl->complete || (node.like && !parents[i]) ||
                (parents[i] && broken[*parents[i]]);
    if (!broken[i]) require_rest(context, layout);
    layout.broken = broken[i] = broken[i] || context.mistakes() != errors;
    context.model.layouts[static_cast<LayoutId>(i)] = std::move(layout);
  }
}

}  // namespace probe::sema
