// `layout`: cells, places and turns as written. What starts they give is starts.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "compiler/define/define.h"
#include "compiler/define/fixture.h"
#include "compiler/define/record.h"
#include "compiler/define/role.h"
#include "compiler/define/start_table.h"
#include "compiler/define/thing.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

// centre - spread + 2 spread i / (n - 1), in exact decimals wherever the result is one, rounded
// once. Decimals that are too long for that are calculated in doubles.
double grid_coordinate(const Decimal& centre, const Decimal& spread, std::uint64_t i,
                       std::uint64_t n) {
  if (n == 1) return centre.to_double();
  const int steps = static_cast<int>(n - 1);
  const int at = 2 * static_cast<int>(i) - steps;
  const auto whole = times(centre, steps), part = times(spread, at);
  const auto sum = whole && part ? plus(*whole, *part) : std::nullopt;
  if (!sum) return centre.to_double() + spread.to_double() * at / steps;
  // A few more decimal places turn a half, a quarter or a fifth of a step into a decimal too.
  std::optional<Decimal> finer = sum;
  for (int digits = 0; digits < 4 && finer; ++digits) {
    if (finer->mantissa % steps == 0)
      return Decimal{finer->mantissa / steps, finer->exponent}.to_double();
    finer = times(*finer, 10);
    if (finer) --finer->exponent;
  }
  // A third of a step is no decimal: round the numerator and the quotient.
  return sum->to_double() / steps;
}

struct LayoutReader {
  Context& context;
  Layout& layout;
  Span decl;
  bool has_orient = false;
  std::map<std::string, Span, std::less<>> placed = {};  // here, not in what is copied
  std::optional<Span> placing = {};  // the first statement here that says where something stands

  // Places and a file of starts say the same twice; in a copy the later takes the other's place.
  void note_placing(const Span& span) {
    if (!placing) placing = span;
    layout.given.clear();
    layout.given_joints.clear();
    layout.given_span = {};
  }
  void operator()(const syntax::StartsStmt& stmt) {
    layout.cells.clear();
    layout.places.clear();
    layout.orients.clear();
    layout.by_rest = false;
    layout.given_span = stmt.span;
    GivenStarts starts = read_start_table(context, stmt);
    layout.given = std::move(starts.places);
    layout.given_joints = std::move(starts.joints);
  }

  void operator()(const syntax::CellsStmt& stmt) {
    note_placing(stmt.span);
    Cells cells{std::string(stmt.name.text), stmt.span, {}, {}};
    const auto at = read_point(context, stmt.at, 2, 2, dim::kLength,
                               Takes::places("`grid ... at` takes lengths"));
    const bool fits =
        stmt.nx.value >= 1 && stmt.ny.value >= 1 && stmt.nx.value <= 1000 && stmt.ny.value <= 1000;
    if (!fits)
      context.report(Situation::kGridSide, join(stmt.nx.span, stmt.ny.span),
                     "expected 1 to 1000 cells a side");
    for (const syntax::Point& point : stmt.spreads) {
      const auto spread =
          read_point(context, point, 2, 2, dim::kLength, Takes::places("`spread` takes lengths"));
      if (!spread || !at || !fits) continue;
      const auto is_flat = [&](std::size_t axis, std::uint64_t side) {
        return side > 1 && (*spread)[axis].si() == 0;
      };
      if (is_flat(0, stmt.nx.value) || is_flat(1, stmt.ny.value)) {
        context.report(Situation::kFlatGrid, point.span, "cells of one row lie in the same place")
            .help("a side of more than one cell needs a spread");
        continue;
      }
      std::vector<Cell> grid;
      const auto coordinates = [&](std::size_t axis, std::uint64_t side) {
        std::vector<double> all;
        for (std::uint64_t i = 0; i < side; ++i)
          all.push_back(grid_coordinate((*at)[axis].exact, (*spread)[axis].exact, i, side));
        return all;
      };
      const std::vector<double> ys = coordinates(1, stmt.ny.value);
      for (const double x : coordinates(0, stmt.nx.value)) {
        for (const double y : ys) grid.push_back({x, y});
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
      const bool is_role = name.text == "distractors" || find_role(context, name.text);
      if (!is_role && !context.symbols.objects.find(name, context.diagnostics)) continue;
      const auto [first, is_new] = placed.emplace(name.text, name.span);
      if (!is_new) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is placed twice")
            .label(first->second, "first here");
        continue;
      }
      result.push_back(spelled(name));
    }
    return result;
  }
  void operator()(const syntax::PlaceAtStmt& stmt) {
    note_placing(stmt.span);
    Place record;
    record.span = stmt.span;
    record.what = placed_names(stmt.names);
    if (const auto at = read_point(context, stmt.at, 2, 2, dim::kLength,
                                   Takes::places("`place ... at` takes lengths"))) {
      record.at = {(*at)[0].si(), (*at)[1].si()};
    }
    place(std::move(record));
  }
  void operator()(const syntax::PlaceInStmt& stmt) {
    note_placing(stmt.span);
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
  void operator()(const syntax::PlaceOnStmt& stmt) {
    note_placing(stmt.span);
    Place record;
    record.span = stmt.span;
    record.how = stmt.in ? Place::kIn : Place::kOn;
    record.what = placed_names(stmt.names);
    record.where = spelled(stmt.where);
    const auto role = find_role(context, stmt.where.text);
    if (role && context.model.roles[*role].is_set) {
      context
          .report(Code::P1105, stmt.where.span,
                  "`" + record.where.text + "` is a set, and one thing is wanted here")
          .label(context.model.roles[*role].span, "declared as a set");
      return;
    }
    if (!role && !find_thing(context, stmt.where)) return;
    place(std::move(record));
  }
  void begin_orient() {
    if (has_orient) return;
    has_orient = true;
    layout.by_rest = false;
    layout.orients.clear();
  }
  void operator()(const syntax::OrientByRestStmt& stmt) {
    note_placing(stmt.span);
    begin_orient();
    layout.by_rest = true;
  }
  void operator()(const syntax::OrientStmt& stmt) {
    note_placing(stmt.span);
    begin_orient();
    if (stmt.what.text != "distractors" && !find_role(context, stmt.what.text) &&
        !context.symbols.objects.find(stmt.what, context.diagnostics)) {
      return;
    }
    if (const auto turns = read_turns(context, stmt.poses))
      layout.orients.push_back({spelled(stmt.what), *turns});
  }
  void operator()(const syntax::JitterStmt& stmt) {
    layout.jitter = read_si(context, stmt.value, dim::kLength,
                            {"`jitter` takes a length", plan::Magnitude::kLength})
                        .value_or(0);
    layout.jitter_span = stmt.value.span;
    if (layout.jitter >= 0) return;
    context.report(Situation::kNegative, stmt.value.span, "expected a jitter of 0 or more");
    layout.jitter = 0;
  }
  void operator()(const syntax::JointsJitterStmt& stmt) {
    layout.joints_jitter =
        read_si(context, stmt.value, dim::kAngle,
                {"`joints jitter` takes an angle", plan::Magnitude::kJointPosition})
            .value_or(0);
    if (layout.joints_jitter >= 0) return;
    context.report(Situation::kNegative, stmt.value.span, "expected a jitter of 0 or more");
    layout.joints_jitter = 0;
  }
  void operator()(const syntax::StartStmt& stmt) {
    read_start(context, stmt, decl, layout.joint_starts);
  }
  void operator()(const syntax::DropStmt& stmt) {
    layout.has_drop = true;
    layout.begins_placed = stmt.none;
    if (stmt.none) {
      layout.drop = layout.settle = 0;
      return;
    }
    layout.drop = read_si(context, stmt.height, dim::kLength,
                          {"`drop` takes a height", plan::Magnitude::kLength})
                      .value_or(0);
    if (layout.drop < 0)
      context.report(Situation::kNegative, stmt.height.span,
                     "objects are dropped from above the surface");
    if (!stmt.settle) return;
    // A phase of the drop; a minute is far beyond what any object needs and still quick to
    // simulate.
    layout.settle =
        read_positive(context, *stmt.settle, dim::kTime, "`settle` takes a time").value_or(1);
    if (layout.settle > plan::kMaxSettle)
      context.report(Situation::kSettleTooLong, stmt.settle->span,
                     "expected at most " + fmt::format("{:g}", plan::kMaxSettle) +
                         "s to settle, found `" +
                         std::string(context.sources.text(stmt.settle->span)) + "`");
  }
  void operator()(const syntax::ExpectEpisodesStmt& stmt) {
    layout.expect = stmt.episodes.value;
    layout.expect_span = stmt.span;
  }
};

// A joint that a file of starts has begins where the file says, in every start.
void check_said_once(Context& context, const Layout& layout) {
  if (layout.given_joints.empty()) return;
  for (const GivenJoint& given : layout.given_joints.front()) {
    for (const JointStart& start : layout.joint_starts) {
      if (start.fixture != given.fixture || start.joint != given.joint) continue;
      context
          .report(Code::P1503, start.span,
                  "`starts` says where `" + given.what.text + "` begins, and this says it again")
          .label(given.what.span, "in the file");
      return;
    }
  }
}

// Objects are put down before an episode and judged when they lie still.
void require_rest(Context& context, const Layout& layout) {
  if (!layout.has_drop) {
    context
        .report(Situation::kStatementMissing, layout.span,
                "layout `" + layout.name + "` has no `drop`")
        .help("write how objects are put down, such as `drop 50cm settle 0.5s`");
  } else if (layout.settle == 0 && !layout.begins_placed) {
    context
        .report(Situation::kStatementMissing, layout.span,
                "layout `" + layout.name + "` has no `settle`")
        .help("without time to come to rest, such as `settle 0.5s`, objects are judged in the air; "
              "`drop none` says that an episode begins so");
  }
}

}  // namespace

void define_layouts(Context& context) {
  const auto read = [&](const Declared<syntax::LayoutDecl>& declared, Layout& layout) {
    LayoutReader reader{context, layout, declared.decl->span};
    const syntax::StartsStmt* starts = nullptr;
    for (const syntax::LayoutStmt& stmt : declared.node->body) {
      if (const auto* given = std::get_if<syntax::StartsStmt>(&stmt)) {
        starts = given;
      } else {
        std::visit(reader, stmt);
      }
    }
    if (starts != nullptr && reader.placing) {
      context
          .report(Code::P1503, *reader.placing,
                  "`starts` says where everything stands, and this says it again")
          .label(starts->span, "the file");
    } else if (starts != nullptr) {
      reader(*starts);
    }
    check_said_once(context, layout);
    // A grid that could not be read has been reported; one cell keeps the enumeration going.
    for (Cells& cells : layout.cells) {
      if (!cells.grids.empty()) continue;
      cells.grids.push_back({{}});
      cells.spreads.push_back({});
    }
  };
  const auto complete = [&](const Layout& layout, bool) { require_rest(context, layout); };
  define_records(context, context.symbols.layouts, context.symbols.layout_decls,
                 context.model.layouts, read, complete);
}

}  // namespace probe::sema
