// Draws diagnostics. A snippet is one source line and its marks; marks on the line of the primary
// place or on the lines right below it share a block, every other line gets its own block headed by
// `:::`.
#include "compiler/diag/text.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "runtime/base/printable.h"
#include "runtime/base/utf8.h"

namespace probe {
namespace {

constexpr std::size_t kTabStop = 4;
// Longer lines are cut: this many columns are shown, a third of them before the first mark.
constexpr std::size_t kMaxColumns = 200;

struct Range {
  std::uint32_t first, last;
};

constexpr Range kWide[] = {{0x1100, 0x115f},   {0x2e80, 0x303e},   {0x3041, 0x33ff},
                           {0x3400, 0x4dbf},   {0x4e00, 0x9fff},   {0xa000, 0xa4cf},
                           {0xac00, 0xd7a3},   {0xf900, 0xfaff},   {0xfe30, 0xfe6f},
                           {0xff00, 0xff60},   {0xffe0, 0xffe6},   {0x1f300, 0x1f64f},
                           {0x1f680, 0x1f6ff}, {0x1f900, 0x1f9ff}, {0x20000, 0x3fffd}};
constexpr Range kZeroWidth[] = {
    {0x0300, 0x036f}, {0x200b, 0x200d}, {0x20d0, 0x20ff}, {0xfe00, 0xfe0f}};

template <std::size_t kCount>
bool is_in(const Range (&ranges)[kCount], std::uint32_t code) {
  return std::any_of(std::begin(ranges), std::end(ranges), [code](const Range& range) {
    return range.first <= code && code <= range.last;
  });
}

// One character of `text` at `at`; a byte that is not UTF-8 is U+FFFD of one byte.
Utf8Char character_at(std::string_view text, std::size_t at) {
  const Utf8Char character = first_utf8(text.substr(at));
  return character.bytes == 0 ? Utf8Char{character.code, 1} : character;
}

// A source line as it is printed, and the printed column at which each asked byte begins.
class PrintedLine {
 public:
  PrintedLine(std::string_view line, std::size_t first_mark) : line_(line) {
    keep_near(first_mark);
    const std::size_t all = measure(line.size());
    if (all > kMaxColumns) {
      const std::size_t mark = measure(first_mark);
      from_ = mark > kMaxColumns / 3 ? mark - kMaxColumns / 3 : 0;
      to_ = from_ + kMaxColumns;
    }
    draw();
  }

  const std::string& text() const { return text_; }
  // Column from 0, within what is shown.
  std::size_t column(std::size_t byte) const {
    const std::size_t column = std::clamp(measure(byte), from_, to_) - from_;
    return column + (from_ > 0 ? kDots.size() : 0);
  }

 private:
  static constexpr std::string_view kDots = "...";

  static std::size_t width(std::uint32_t code, std::size_t column) {
    if (code == '\t') return kTabStop - column % kTabStop;
    if (is_unsafe(code)) return 1;
    if (code < 0x300) return 1;
    return is_in(kZeroWidth, code) ? 0 : is_in(kWide, code) ? 2 : 1;
  }

  // A line of megabytes is not measured as a whole for each of its marks: only the bytes around the
  // first one count.
  void keep_near(std::size_t mark) {
    constexpr std::size_t kBefore = 1024, kKept = 4096;
    if (line_.size() <= kKept) return;
    skipped_ = mark > kBefore ? mark - kBefore : 0;
    while (skipped_ > 0 && is_utf8_tail(line_[skipped_])) --skipped_;
    line_ = line_.substr(skipped_, kKept);
  }

  // Columns between the first byte kept and byte `end` of the line.
  std::size_t measure(std::size_t end) const {
    end = end > skipped_ ? end - skipped_ : 0;
    std::size_t column = 0;
    for (std::size_t at = 0; at < std::min(end, line_.size());) {
      const Utf8Char character = character_at(line_, at);
      column += width(character.code, column);
      at += character.bytes;
    }
    return column;
  }

  void draw() {
    std::size_t column = 0;
    if (from_ > 0) text_ += kDots;
    for (std::size_t at = 0; at < line_.size();) {
      const Utf8Char character = character_at(line_, at);
      const std::size_t columns = width(character.code, column);
      if (column >= to_) {
        text_ += kDots;
        break;
      }
      if (column >= from_) {
        if (character.code == '\t') {
          text_.append(columns, ' ');
        } else if (character.code == 0xfffd || is_unsafe(character.code)) {
          text_ += "\xef\xbf\xbd";
        } else {
          text_ += line_.substr(at, character.bytes);
        }
      } else if (column + columns > from_) {
        text_.append(column + columns - from_, ' ');  // the cut goes through a wide character
      }
      column += columns;
      at += character.bytes;
    }
    while (!text_.empty() && text_.back() == ' ') text_.pop_back();
  }

  std::string_view line_;    // what is kept of it
  std::size_t skipped_ = 0;  // bytes of the line before that
  std::size_t from_ = 0;     // columns shown

  std::size_t to_ = static_cast<std::size_t>(-1);
  std::string text_;
};

struct Mark {
  Span span;
  std::string_view text;
  bool carets;
};

struct Snippet {
  FileId file;
  std::uint32_t line;
  std::vector<Mark> marks;
};

struct Block {
  std::vector<Snippet> snippets;  // lines that follow one another
};

class Painter {
 public:
  Painter(const SourceSet& sources, TextStyle style) : sources_(sources), style_(style) {}

  std::string draw(const Diagnostic& diagnostic) {
    const bool error = diagnostic.severity == Severity::kError;
    mark_colour_ = error ? "\x1b[1;31m" : "\x1b[1;33m";
    paint(mark_colour_, std::string(to_text(diagnostic.severity)) + "[" +
                            std::string(info(diagnostic.code).text) + "]");
    paint("\x1b[1m", ": " + safe(diagnostic.message));
    out_ += '\n';
    const std::vector<Block> blocks = arrange(diagnostic);
    std::uint32_t largest = 1;
    for (const Block& block : blocks) {
      for (const Snippet& snippet : block.snippets) largest = std::max(largest, snippet.line);
    }
    gutter_ = std::to_string(largest).size();
    for (std::size_t i = 0; i < blocks.size(); ++i) draw_block(blocks[i], i == 0 ? "--> " : "::: ");
    draw_helps(diagnostic, !blocks.empty());
    return std::move(out_);
  }

 private:
  void paint(const char* colour, std::string_view text) {
    if (style_.colour) out_ += colour;
    out_ += text;
    if (style_.colour) out_ += "\x1b[0m";
  }

  // Messages quote source text; what must not reach a terminal is replaced, line breaks stay.
  static std::string safe(std::string_view text) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
      const Utf8Char character = character_at(text, at);
      const bool bad =
          character.code == 0xfffd || (character.code != '\n' && is_unsafe(character.code));
      if (bad) {
        out += character.code == '\t' ? " " : "\xef\xbf\xbd";
      } else {
        out += text.substr(at, character.bytes);
      }
      at += character.bytes;
    }
    return out;
  }

  std::uint32_t line_of(const Span& span) const {
    return sources_.file(span.file).line_of(span.begin);
  }

  std::vector<Block> arrange(const Diagnostic& diagnostic) const {
    std::vector<Block> blocks;
    if (diagnostic.primary.is_none()) return blocks;
    const Mark primary{diagnostic.primary, diagnostic.primary_label, true};
    blocks.push_back({{{primary.span.file, line_of(primary.span), {primary}}}});
    std::vector<Mark> rest;
    for (const Label& label : diagnostic.labels) {
      if (!label.span.is_none()) rest.push_back({label.span, label.text, label.carets});
    }
    std::stable_sort(rest.begin(), rest.end(), [&](const Mark& a, const Mark& b) {
      const bool near_a = follows(a, primary), near_b = follows(b, primary);
      if (near_a != near_b) return near_a;
      return near_a && a.span.begin < b.span.begin;
    });
    for (const Mark& mark : rest) place(mark, blocks);
    return blocks;
  }

  static bool follows(const Mark& mark, const Mark& primary) {
    return mark.span.file == primary.span.file && mark.span.begin >= primary.span.begin;
  }

  void place(const Mark& mark, std::vector<Block>& blocks) const {
    const std::uint32_t line = line_of(mark.span);
    for (Block& block : blocks) {
      for (Snippet& snippet : block.snippets) {
        if (snippet.file == mark.span.file && snippet.line == line) {
          snippet.marks.push_back(mark);
          return;
        }
      }
      const Snippet& last = block.snippets.back();
      if (last.file == mark.span.file && last.line + 1 == line) {
        block.snippets.push_back({mark.span.file, line, {mark}});
        return;
      }
    }
    blocks.push_back({{{mark.span.file, line, {mark}}}});
  }

  void bar(std::string_view after = "") {
    paint("\x1b[1;34m", std::string(gutter_, ' ') + " |");
    out_ += after;
  }

  void draw_block(const Block& block, std::string_view arrow) {
    const Span& span = block.snippets.front().marks.front().span;
    const SourceFile& file = sources_.file(span.file);
    const LineColumn place = file.line_column(span.begin);
    paint("\x1b[1;34m", std::string(gutter_, ' ') + std::string(arrow));
    out_ += safe(file.name()) + ":" + std::to_string(place.line) + ":" +
            std::to_string(place.column) + "\n";
    bar("\n");
    for (const Snippet& snippet : block.snippets) draw_snippet(snippet);
  }

  void draw_snippet(const Snippet& snippet) {
    const SourceFile& file = sources_.file(snippet.file);
    const std::string_view text = file.line(snippet.line);
    const std::uint32_t start = file.line_start(snippet.line);
    const auto clip = [&](std::uint32_t offset) {
      return std::min<std::size_t>(offset - start, text.size());
    };
    const PrintedLine printed(text, clip(snippet.marks.front().span.begin));
    const std::string number = std::to_string(snippet.line);
    paint("\x1b[1;34m", std::string(gutter_ - number.size(), ' ') + number + " |");
    if (!printed.text().empty()) out_.append(" ").append(printed.text());
    out_ += '\n';
    for (const Mark& mark : snippet.marks) {
      const std::size_t begin = printed.column(clip(mark.span.begin));
      const std::size_t end =
          printed.column(clip(mark.span.end));  // a span over several lines ends with the first
      const std::size_t width = end > begin ? end - begin : 1;
      bar(std::string(begin + 1, ' '));
      std::string drawn(width, mark.carets ? '^' : '-');
      if (!mark.text.empty()) drawn.append(" ").append(one_line(mark.text));
      paint(mark.carets ? mark_colour_ : "\x1b[1;34m", drawn);
      out_ += '\n';
    }
  }

  static std::string one_line(std::string_view text) {
    std::string out = safe(text);
    std::replace(out.begin(), out.end(), '\n', ' ');
    return out;
  }

  void draw_helps(const Diagnostic& diagnostic, bool after_block) {
    const bool any = diagnostic.fix || !diagnostic.helps.empty() || !diagnostic.notes.empty();
    if (!any) return;
    if (after_block) bar("\n");
    if (diagnostic.fix) draw_help("help: ", diagnostic.fix->message);
    for (const std::string& help : diagnostic.helps) draw_help("help: ", help);
    for (const std::string& note : diagnostic.notes) draw_help("note: ", note);
  }

  void draw_help(std::string_view word, std::string_view text) {
    const std::string clean = safe(text);
    std::string_view rest = clean;
    for (bool first = true; first || !rest.empty(); first = false) {
      const std::size_t newline = std::min(rest.find('\n'), rest.size());
      paint("\x1b[1;34m", std::string(gutter_, ' ') + " = ");
      if (first) {
        paint("\x1b[1m", word);
      } else {
        out_.append(word.size(), ' ');
      }
      out_ += rest.substr(0, newline);
      out_ += '\n';
      rest = newline < rest.size() ? rest.substr(newline + 1) : std::string_view();
    }
  }

  const SourceSet& sources_;
  TextStyle style_;
  const char* mark_colour_ = "";
  std::size_t gutter_ = 1;
  std::string out_;
};

}  // namespace

std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources, TextStyle style) {
  return Painter(sources, style).draw(diagnostic);
}

std::string render_text(const Diagnostics& diagnostics, const SourceSet& sources, TextStyle style) {
  std::string out;
  for (const Diagnostic* item : diagnostics.in_source_order()) {
    if (!out.empty()) out += '\n';
    out += render_text(*item, sources, style);
  }
  return out;
}

}  // namespace probe
