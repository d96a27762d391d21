#include "compiler/define/start_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <tuple>

#include "compiler/define/role.h"
#include "compiler/define/task.h"
#include "compiler/names/quantities.h"

namespace probe::sema {
namespace {

// In the order of kColumns; the first kNeeded have to be there, and of a rotation all or none.
enum TableColumn : std::size_t { kStart, kObject, kX, kY, kZ, kQw, kQx, kQy, kQz, kValue };
constexpr std::array<std::string_view, 10> kColumns = {"start", "object", "x_m", "y_m", "z_m",
                                                       "qw",    "qx",     "qy",  "qz",  "value"};
// A joint may have been stored with six digits, or a hair beyond its limit.
constexpr double kBeyondLimit = 1e-6;
constexpr std::size_t kNeeded = kZ;
// Tables that are written with six digits have quaternions of about length 1.
constexpr double kUnitWithin = 1e-5;
// A table that is wrong in one row is often wrong in all.
constexpr std::size_t kMostMistakes = 5;

struct TableCell {
  std::string_view text;
  Span span;
};

class StartTable {
 public:
  StartTable(Context& context, FileId id)
      : context_(context), file_(context.sources.file(id)), id_(id) {}

  GivenStarts read() {
    const std::size_t before = context_.mistakes();
    std::uint32_t line = 1;
    while (line <= file_.line_count() && is_nothing(line)) ++line;
    if (line > file_.line_count()) {
      context_.report(Situation::kStartsEmpty, Span{id_, 0, 0}, "the file of starts is empty")
          .help("its first line names the columns: start, object, x_m, y_m");
      return {};
    }
    if (!read_header(line)) return {};
    for (++line; line <= file_.line_count(); ++line) {
      if (!is_nothing(line)) read_row(line);
      if (context_.mistakes() - before >= kMostMistakes) return {};
    }
    if (context_.mistakes() != before) return {};
    check_alike();
    if (context_.mistakes() != before) return {};
    if (starts_.empty())
      context_.report(Situation::kStartsEmpty, header_, "there are no starts below this line");
    return {std::move(starts_), std::move(joints_)};
  }

 private:
  // Empty lines and comments.
  bool is_nothing(std::uint32_t line) const {
    const auto text = file_.line(line);
    const std::size_t at = text.find_first_not_of(" \t");
    return at == text.npos || text[at] == '#';
  }

  Span whole(std::uint32_t line) const {
    const std::uint32_t begin = file_.line_start(line);
    return {id_, begin, begin + static_cast<std::uint32_t>(file_.line(line).size())};
  }

  // Between commas, without blanks and without quotes around it.
  std::vector<TableCell> cells_of(std::uint32_t line) const {
    std::vector<TableCell> cells;
    const std::string_view text = file_.line(line);
    std::size_t from = line == 1 && text.starts_with("\xef\xbb\xbf") ? 3 : 0;
    while (true) {
      std::size_t end = std::min(text.find(',', from), text.size());
      const std::size_t next = end + 1;
      std::size_t begin = from;
      while (begin < end && (text[begin] == ' ' || text[begin] == '\t')) ++begin;
      while (end > begin && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
      if (end - begin >= 2 && text[begin] == '"' && text[end - 1] == '"') ++begin, --end;
      const std::uint32_t start = file_.line_start(line);
      cells.push_back({text.substr(begin, end - begin),
                       {id_, start + static_cast<std::uint32_t>(begin),
                        start + static_cast<std::uint32_t>(end)}});
      if (next > text.size()) return cells;
      from = next;
    }
  }

  bool read_header(std::uint32_t line) {
    header_ = whole(line);
    const std::vector<TableCell> cells = cells_of(line);
    width_ = cells.size();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto known = std::find(kColumns.begin(), kColumns.end(), cells[i].text);
      if (known == kColumns.end()) {
        const std::vector<std::string_view> words(kColumns.begin(), kColumns.end());
        const auto near = nearest(cells[i].text, words);
        context_
            .report(Situation::kStartsColumns, cells[i].span,
                    "unknown column `" + std::string(cells[i].text) + "`")
            .help(near && cells[i].text.size() > 2
                      ? "did you mean `" + std::string(*near) + "`?"
                      : "the columns are start, object, x_m, y_m and, if wanted, z_m, qw, qx, qy, "
                        "qz and value");
        return false;
      }
      auto& at = at_[static_cast<std::size_t>(known - kColumns.begin())];
      if (at) {
        context_.report(Situation::kStartsColumns, cells[i].span,
                        "column `" + std::string(cells[i].text) + "` is there twice");
        return false;
      }
      at = i;
    }
    const bool turns = at_[kQw] || at_[kQx] || at_[kQy] || at_[kQz];
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
      if (at_[c] || (c >= kNeeded && !(turns && c >= kQw && c <= kQz))) continue;
      context_.report(Situation::kStartsColumns, header_,
                      "there is no column `" + std::string(kColumns[c]) + "`");
      return false;
    }
    return true;
  }

  // Nothing when it was reported.
  std::optional<double> number(const TableCell& cell, TableColumn column) {
    double value = 0;
    const char* const end = cell.text.data() + cell.text.size();
    const auto [at, error] = std::from_chars(cell.text.data(), end, value);
    if (cell.text.empty() || error != std::errc() || at != end || !std::isfinite(value)) {
      context_.report(Situation::kStartsNumber, cell.span,
                      "expected a number under `" + std::string(kColumns[column]) + "`, found " +
                          (cell.text.empty() ? "nothing" : "`" + std::string(cell.text) + "`"));
      return std::nullopt;
    }
    const bool is_place = column < kQw || column == kValue;
    const auto magnitude =
        column == kValue ? plan::Magnitude::kJointPosition : plan::Magnitude::kPlace;
    if (is_place && !check_magnitude(context_, cell.span, value, magnitude)) return std::nullopt;
    return value;
  }

  std::optional<std::array<double, 4>> rotation(const std::vector<TableCell>& cells) {
    std::array<double, 4> q{};
    double squares = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto column = static_cast<TableColumn>(kQw + i);
      const auto value = number(cells[*at_[column]], column);
      if (!value) return std::nullopt;
      q[i] = *value;
      squares += q[i] * q[i];
    }
    const double length = std::sqrt(squares);
    if (!(std::abs(length - 1) <= kUnitWithin)) {
      const Span span = join(cells[*at_[kQw]].span, cells[*at_[kQz]].span);
      Diagnostic& said = context_.report(Situation::kNotUnit, span,
                                         fmt::format("a quaternion has length 1, this one {:.6f}", length));
      if (length > 0)
        said.help(fmt::format("divided by its length it is {:.6g},{:.6g},{:.6g},{:.6g}", q[0] / length,
                              q[1] / length, q[2] / length, q[3] / length));
      else
        said.help("what is not turned has 1,0,0,0");
      return std::nullopt;
    }
    for (double& value : q) value /= length;
    return q;
  }

  // Every start has the objects and the joints of the first: what stands in a scene does not come
  // and go, and a joint that begins elsewhere in one start is said in all.
  void check_alike() {
    if (check_alike(starts_)) check_alike(joints_);
  }
  template <typename Given>
  bool check_alike(const std::vector<std::vector<Given>>& starts) {
    const auto lacks = [](const std::vector<Given>& start, const Given& wanted) {
      return std::none_of(start.begin(), start.end(),
                          [&](const Given& place) { return place.what.text == wanted.what.text; });
    };
    for (std::size_t i = 1; i < starts.size(); ++i) {
      const std::vector<Given>&first = starts.front(), &here = starts[i];
      for (const auto& [from, in, number, other] : {std::tuple(&first, &here, i, std::size_t{0}),
                                                    std::tuple(&here, &first, std::size_t{0}, i)}) {
        const std::vector<Given>& compared = *in;  // clang 14 captures no binding
        const auto missing = std::find_if(
            from->begin(), from->end(), [&](const Given& place) { return lacks(compared, place); });
        if (missing == from->end()) continue;
        context_
            .report(Situation::kStartLacks, begins_[number],
                    "start " + std::to_string(number) + " has no `" + missing->what.text + "`")
            .label(missing->what.span, "start " + std::to_string(other) + " has")
            .help("add a row for `" + missing->what.text + "` to start " + std::to_string(number));
        return false;
      }
    }
    return true;
  }

  // The start that a row belongs to: the last one or the next.
  bool find_start(const TableCell& cell) {
    std::uint64_t index = 0;
    const char* const end = cell.text.data() + cell.text.size();
    const auto [at, error] = std::from_chars(cell.text.data(), end, index);
    const bool is_number = !cell.text.empty() && error == std::errc() && at == end;
    if (is_number && index + 1 == starts_.size()) return true;
    if (is_number && index == starts_.size() && index < kMaxEpisodes) {
      starts_.emplace_back();
      joints_.emplace_back();
      return true;
    }
    const std::size_t next = starts_.size();
    context_
        .report(Situation::kStartsOrder, cell.span,
                "expected start " +
                    (next == 0 ? "0" : std::to_string(next - 1) + " or " + std::to_string(next)) +
                    ", found `" + std::string(cell.text) + "`")
        .help("starts are numbered from 0, and the rows of one stand together");
    return false;
  }

  // A role that one object fills, or an object.
  bool find_object(const TableCell& cell) {
    const syntax::Name name{cell.span, cell.text};
    if (cell.text == "distractors") return true;
    if (find_role(context_, cell.text)) return find_single_role(context_, name).has_value();
    return context_.symbols.objects.find(name, context_.diagnostics).has_value();
  }

  void read_row(std::uint32_t line) {
    const std::vector<TableCell> cells = cells_of(line);
    if (cells.size() != width_) {
      context_
          .report(Situation::kStartsCells, whole(line),
                  "this row has " + std::to_string(cells.size()) + " cells, the header " +
                      std::to_string(width_))
          .label(header_, "the header");
      return;
    }
    if (!find_start(cells[*at_[kStart]])) return;
    const TableCell& object = cells[*at_[kObject]];
    if (begins_.size() < starts_.size()) begins_.push_back(object.span);
    if (object.text.find('.') != object.text.npos) return read_joint(cells);
    if (!find_object(object)) return;
    std::vector<GivenPlace>& start = starts_.back();
    if (is_there(start, object)) return;
    if (at_[kValue] && !is_empty(cells, kValue, "an object has no joint value")) return;
    GivenPlace place;
    place.what = {std::string(object.text), object.span};
    const auto x = number(cells[*at_[kX]], kX), y = number(cells[*at_[kY]], kY);
    if (!x || !y) return;
    place.x = *x;
    place.y = *y;
    if (at_[kZ]) {
      place.z = number(cells[*at_[kZ]], kZ);
      if (!place.z) return;
      place.z_span = cells[*at_[kZ]].span;
    }
    if (at_[kQw]) {
      place.rotation = rotation(cells);
      if (!place.rotation) return;
    }
    start.push_back(std::move(place));
  }

  // Whether the start has a row of that name, which is reported.
  template <typename Given>
  bool is_there(const std::vector<Given>& start, const TableCell& object) {
    for (const Given& known : start) {
      if (known.what.text != object.text) continue;
      context_
          .report(Situation::kStartTwice, object.span,
                  "start " + std::to_string(starts_.size() - 1) + " has `" +
                      std::string(object.text) + "` twice")
          .label(known.what.span, "here already");
      return true;
    }
    return false;
  }

  bool is_empty(const std::vector<TableCell>& cells, TableColumn column, const char* why) {
    const TableCell& cell = cells[*at_[column]];
    if (cell.text.empty()) return true;
    context_.report(Situation::kStartsNumber, cell.span,
                    std::string(why) + ": expected nothing under `" +
                        std::string(kColumns[column]) + "`, found `" + std::string(cell.text) +
                        "`");
    return false;
  }

  // `cabinet.top`, `panda.joint1`: a value alone.
  void read_joint(const std::vector<TableCell>& cells) {
    const TableCell& what = cells[*at_[kObject]];
    if (is_there(joints_.back(), what)) return;
    if (!at_[kValue]) {
      context_.report(Situation::kStartsColumns, what.span,
                      "`" + std::string(what.text) +
                          "` is a joint, and the table has no column `value` for where it begins");
      return;
    }
    for (const TableColumn column : {kX, kY, kZ, kQw, kQx, kQy, kQz}) {
      if (at_[column] && !is_empty(cells, column, "a joint has no place")) return;
    }
    GivenJoint joint;
    joint.what = {std::string(what.text), what.span};
    const auto limits = find_joint(what, joint);
    if (!limits) return;
    const TableCell& cell = cells[*at_[kValue]];
    const auto value = number(cell, kValue);
    if (!value) return;
    if (*value < limits->first - kBeyondLimit || *value > limits->second + kBeyondLimit) {
      context_.report(Situation::kJointLimit, cell.span,
                      fmt::format("joint `{}` begins at {:.6g}, beyond its limits of {:.6g} and "
                                  "{:.6g}",
                                  what.text, *value, limits->first, limits->second));
      return;
    }
    joint.value = std::clamp(*value, limits->first, limits->second);
    joints_.back().push_back(std::move(joint));
  }

  // Which joint that is, and its limits; nothing when it was reported, here or before.
  std::optional<std::pair<double, double>> find_joint(const TableCell& cell, GivenJoint& found) {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const std::size_t dot = cell.text.find('.');
    const auto part = [&](std::size_t from, std::size_t to) {
      const auto begin = cell.span.begin + static_cast<std::uint32_t>(from);
      return syntax::Name{{id_, begin, cell.span.begin + static_cast<std::uint32_t>(to)},
                          cell.text.substr(from, to - from)};
    };
    const syntax::Name owner = part(0, dot), name = part(dot + 1, cell.text.size());
    std::vector<std::string_view> known;
    if (const auto robot = context_.symbols.robots.peek(owner.text)) {
      found.robot = static_cast<RobotId>(*robot);
      const Robot& record = context_.model.robots[found.robot];
      if (record.broken || !record.model) return std::nullopt;
      for (std::uint32_t i = 0; i < record.drives.size(); ++i) {
        known.push_back(record.drives[i].joint.text);
        if (known.back() != name.text) continue;
        found.joint = i;
        const int at = record.model->find_joint(name.text);
        if (at < 0) return std::nullopt;
        const robot::Joint& limits = record.model->joints[static_cast<std::size_t>(at)];
        if (limits.kind == robot::JointKind::kContinuous) return std::pair(-kEndless, kEndless);
        return std::pair(limits.lower, limits.upper);
      }
      report_unknown(context_.diagnostics, "joint of `" + record.name + "`", name, known)
          .label(record.span, "the robot");
      return std::nullopt;
    }
    const auto fixture = context_.symbols.fixtures.find(owner, context_.diagnostics);
    if (!fixture) return std::nullopt;
    found.fixture = static_cast<FixtureId>(*fixture);
    const Fixture& record = context_.model.fixtures[found.fixture];
    if (record.broken) return std::nullopt;
    for (std::uint32_t i = 0; i < record.joints.size(); ++i) {
      const Fixture::Joint& joint = record.joints[i];
      known.push_back(joint.name);
      if (joint.name != name.text) continue;
      found.joint = i;
      if (joint.is_endless) return std::pair(-kEndless, kEndless);
      return std::pair(joint.lower, joint.upper);
    }
    report_unknown(context_.diagnostics, "joint of `" + record.name + "`", name, known)
        .label(record.span, "the fixture");
    return std::nullopt;
  }

  Context& context_;
  const SourceFile& file_;
  FileId id_;
  Span header_;
  std::size_t width_ = 0;
  std::array<std::optional<std::size_t>, kColumns.size()> at_{};  // the cell of each column
  std::vector<std::vector<GivenPlace>> starts_;
  std::vector<std::vector<GivenJoint>> joints_;
  std::vector<Span> begins_;  // the first row of each
};

}  // namespace

GivenStarts read_start_table(Context& context, const syntax::StartsStmt& stmt) {
  if (stmt.file.is_none()) return {};  // which was reported
  if (context.sources.file(stmt.file).text().size() > kMaxSourceBytes) {
    context.report(
        Situation::kStartsEmpty, stmt.path.span,
        "a file of starts has at most " + std::to_string(kMaxSourceBytes >> 20) + " MiB");
    return {};
  }
  return StartTable(context, stmt.file).read();
}

}  // namespace probe::sema
