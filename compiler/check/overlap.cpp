// P0501: two footprints in one another, in any start.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "compiler/check/starts.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/pose.h"

namespace probe::sema {
namespace {

// Rounded up to a whole millimetre: what is advised has to fit.
std::string millimetre_up(double metres) {
  return centimetres(std::ceil(metres * 1000 - 1e-6) / 1000);
}

// Of the grid on which both stand.
const Cells::Spread* spread_of(const Layout& layout, const Start::Placed& a,
                               const Start::Placed& b) {
  for (const Cells& cells : layout.cells) {
    for (std::size_t g = 0; g < cells.grids.size(); ++g) {
      const auto holds = [&](const Start::Placed& placed) {
        return std::any_of(cells.grids[g].begin(), cells.grids[g].end(), [&](const Cell& cell) {
          return cell.x == placed.x && cell.y == placed.y;
        });
      };
      if (holds(a) && holds(b)) return &cells.spreads[g];
    }
  }
  return nullptr;
}

// Whether the cells of a grid that is so much wider, about its middle, are still over the surface.
bool fits_surface(const TaskStarts& starts, const std::vector<Cell>& grid, double factor) {
  const std::array<double, 4>& area = starts.model.scenes[starts.task.scene].area;
  double x = 0, y = 0;
  for (const Cell& cell : grid) x += cell.x, y += cell.y;
  const auto number = static_cast<double>(grid.size());
  x /= number, y /= number;
  return std::ranges::all_of(grid, [&](const Cell& cell) {
    const double at_x = x + (cell.x - x) * factor, at_y = y + (cell.y - y) * factor;
    return at_x >= area[0] && at_x <= area[2] && at_y >= area[1] && at_y <= area[3];
  });
}

// At each spread that is too small, the least of the same shape at which nothing overlaps.
// Nothing is said when something overlaps that a spread does not move apart.
bool advise_spread(const TaskStarts& starts, Diagnostic& said) {
  if (starts.layout.jitter > 0) return false;
  std::map<const Cells::Spread*, double> factors;
  for (const Start& start : starts.task.starts) {
    for (std::size_t i = 0; i < start.placed.size(); ++i) {
      for (std::size_t j = i + 1; j < start.placed.size(); ++j) {
        const Start::Placed &a = start.placed[i], &b = start.placed[j];
        const Footprint one = footprint(starts.object(a), a), two = footprint(starts.object(b), b);
        if (overlap(one, two) <= 1e-6) continue;
        const Cells::Spread* spread = spread_of(starts.layout, a, b);
        if (spread == nullptr) return false;
        const auto factor = growth(one, two, {b.x - a.x, b.y - a.y});
        if (!factor) return false;
        double& most = factors[spread];
        most = std::max(most, *factor);
      }
    }
  }
  for (const Cells& cells : starts.layout.cells) {
    for (std::size_t g = 0; g < cells.spreads.size(); ++g) {
      const Cells::Spread& spread = cells.spreads[g];
      const auto found = factors.find(&spread);
      if (found == factors.end()) continue;
      if (!fits_surface(starts, cells.grids[g], found->second)) {
        said.label(spread.span,
                   "however wide, these objects do not fit: what would be enough reaches over the "
                   "edge of the surface");
        continue;
      }
      const std::string x = millimetre_up(spread.x * found->second);
      const std::string y = millimetre_up(spread.y * found->second);
      said.label(spread.span,
                 (x == y ? x : "(" + x + ", " + y + ")") + " is the least that fits these objects");
    }
  }
  return true;
}

// How deep two objects stand in one another; where heights are given one may stand over the other.
double overlap_of(const TaskStarts& starts, const Start::Placed& a, const Start::Placed& b) {
  if (a.z && b.z) {
    const auto bottom = [&](const Start::Placed& placed) {
      const Mat3 turn = axes_of(placed.turn);
      return *placed.z + lowest(starts.object(placed), turn);
    };
    const double low = bottom(a), high = bottom(b);
    const double top_of_lower = low < high ? low + height(starts.object(a), a.turn)
                                           : high + height(starts.object(b), b.turn);
    if (top_of_lower <= std::max(low, high)) return 0;
  }
  return overlap(footprint(starts.object(a), a), footprint(starts.object(b), b));
}

// Farther from one another than both reach: most are.
bool are_far(double reach, const Start::Placed& a, const Start::Placed& b) {
  const double x = b.x - a.x, y = b.y - a.y;
  return x * x + y * y > reach * reach;
}

}  // namespace

void check_overlap(const TaskStarts& starts) {
  // By pair of objects, in the order in which they are found.
  struct Pair {
    const Start::Placed *one, *other;  // in the first start in which they overlap
    double depth;
    CountedStarts counted;
  };
  std::vector<Pair> pairs;
  // By object, in the order in which every start has them.
  std::vector<double> reach;
  if (!starts.task.starts.empty()) {
    for (const Start::Placed& placed : starts.task.starts.front().placed)
      reach.push_back(reach_of(starts.object(placed)));
  }
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    const auto& placed = starts.task.starts[e].placed;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      for (std::size_t j = i + 1; j < placed.size(); ++j) {
        if (are_far(reach[i] + reach[j], placed[i], placed[j])) continue;
        // Boxes may touch: less than a micrometre is rounding.
        const double now = overlap_of(starts, placed[i], placed[j]);
        if (now <= 1e-6) continue;
        auto pair = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& known) {
          return known.one->object == placed[i].object && known.other->object == placed[j].object;
        });
        if (pair == pairs.end())
          pair = pairs.insert(pair, {&placed[i], &placed[j], now, {0, starts.task.starts.size()}});
        pair->counted.add(e);
      }
    }
  }
  if (pairs.empty()) return;
  const Pair& first = pairs.front();
  const Object &one = starts.object(*first.one), &other = starts.object(*first.other);
  Diagnostic& said =
      starts.reporter
          .report(Code::P0501, starts.place({first.one->object, first.other->object}),
                  "`" + one.name + "` and `" + other.name + "` overlap by " +
                      centimetres(first.depth) + " " + first.counted.text() + " `" +
                      starts.task.name + "`")
          .point(first.counted.first_words(at(one, *first.one) + ", " + at(other, *first.other)));
  said.cause = cause_of(starts.layout.span, {one.name, other.name});
  if (!advise_spread(starts, said)) said.label(starts.layout.span, "the layout");
  // Heights were chosen or recorded: a thing may stand within the box around a hollow one.
  const bool are_given =
      std::ranges::all_of(pairs, [](const Pair& pair) { return pair.one->z && pair.other->z; });
  if (are_given) {
    said.severity = Severity::kWarning;
    said.help("if they are to begin so, say why: `@allow(overlap, \"...\")`");
  }
  if (pairs.size() > 1)
    said.note("so do " + std::to_string(pairs.size() - 1) + " other pair" +
              (pairs.size() > 2 ? "s" : "") + " of its objects");
}

}  // namespace probe::sema
