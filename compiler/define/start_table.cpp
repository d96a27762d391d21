#include "compiler/define/start_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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
enum TableColumn : std::size_t { kStart, kObject, kX, kY, kZ, kQw, kQx, kQy, kQz };
constexpr std::array<std::string_view, 9> kColumns = {"start", "object", "x_m", "y_m", "z_m",
                                                      "qw",    "qx",     "qy",  "qz"};
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

  std::vector<std::vector<GivenPlace>> read() {
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
    return std::move(starts_);
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
            .help(near ? "did you mean `" + std::string(*near) + "`?"
                       : "the columns are start, object, x_m, y_m and, if wanted, z_m and qw, qx, "
                         "qy, qz");
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
      if (at_[c] || (c >= kNeeded && !(turns && c >= kQw))) continue;
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
    if (column < kQw && !check_magnitude(context_, cell.span, value, plan::Magnitude::kPlace))
      return std::nullopt;
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
      context_.report(Situation::kNotUnit, span,
                      "a quaternion has length 1, this one " + std::to_string(length));
      return std::nullopt;
    }
    for (double& value : q) value /= length;
    return q;
  }

  // Every start has the objects of the first: what stands in a scene does not come and go.
  void check_alike() {
    const auto lacks = [](const std::vector<GivenPlace>& start, const GivenPlace& wanted) {
      return std::none_of(start.begin(), start.end(), [&](const GivenPlace& place) {
        return place.what.text == wanted.what.text;
      });
    };
    for (std::size_t i = 1; i < starts_.size(); ++i) {
      const std::vector<GivenPlace>&first = starts_.front(), &here = starts_[i];
      for (const auto& [from, in, number, other] : {std::tuple(&first, &here, i, std::size_t{0}),
                                                    std::tuple(&here, &first, std::size_t{0}, i)}) {
        const std::vector<GivenPlace>& compared = *in;  // clang 14 captures no binding
        const auto missing = std::find_if(from->begin(), from->end(), [&](const GivenPlace& place) {
          return lacks(compared, place);
        });
        if (missing == from->end()) continue;
        context_
            .report(Situation::kStartLacks, in->front().what.span,
                    "start " + std::to_string(number) + " has no `" + missing->what.text + "`")
            .label(missing->what.span, "start " + std::to_string(other) + " has");
        return;
      }
    }
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
    if (!find_object(object)) return;
    std::vector<GivenPlace>& start = starts_.back();
    for (const GivenPlace& known : start) {
      if (known.what.text != object.text) continue;
      context_
          .report(Situation::kStartTwice, object.span,
                  "start " + std::to_string(starts_.size() - 1) + " has `" +
                      std::string(object.text) + "` twice")
          .label(known.what.span, "here already");
      return;
    }
    GivenPlace place;
    place.what = {std::string(object.text), object.span};
    const auto x = number(cells[*at_[kX]], kX), y = number(cells[*at_[kY]], kY);
    if (!x || !y) return;
    place.x = *x;
    place.y = *y;
    if (at_[kZ]) {
      place.z = number(cells[*at_[kZ]], kZ);
      if (!place.z) return;
    }
    if (at_[kQw]) {
      place.rotation = rotation(cells);
      if (!place.rotation) return;
    }
    start.push_back(std::move(place));
  }

  Context& context_;
  const SourceFile& file_;
  FileId id_;
  Span header_;
  std::size_t width_ = 0;
  std::array<std::optional<std::size_t>, kColumns.size()> at_{};  // the cell of each column
  std::vector<std::vector<GivenPlace>> starts_;
};

}  // namespace

std::vector<std::vector<GivenPlace>> read_start_table(Context& context,
                                                      const syntax::StartsStmt& stmt) {
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
