// What is said to the author of a .probe text, as data: collected by every pass, rendered by text.h
// and json.h. Wording: lower case, no full stop, backticks round source, what was seen before what
// was wanted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace probe {

enum class Severity : std::uint8_t { kError, kWarning };

enum class Code : std::uint16_t {
#define PROBE_CODE(code, severity, slug, title) code,
#include "compiler/diag/codes.def"
};

// What is the case, where a code stands for several things.
enum class Situation : std::uint16_t {
  kNone,  // the code says it all
#define PROBE_SITUATION(code, name, meaning) name,
#include "compiler/diag/codes.def"
};

struct CodeInfo {
  Code code;
  std::string_view text;  // "P0402"
  Severity severity;
  std::string_view slug;  // for @allow; empty when it cannot be allowed
  std::string_view title;
};

const CodeInfo& info(Code code);
std::string_view to_text(Severity severity);  // "error", "warning"
std::optional<Code> code_from_text(std::string_view text);
// The code that @allow(slug, ...) silences.
std::optional<Code> code_from_slug(std::string_view slug);
Code code_of(Situation situation);  // not of kNone
// Every code in the order of codes.def.
std::vector<Code> all_codes();

// Why another place matters. Drawn with dashes, or with carets like the primary place when it is
// just as guilty.
struct Label {
  Span span;
  std::string text;
  bool carets = false;
};

struct Replacement {
  Span span;  // empty: an insertion
  std::string text;
};

// Offered only when applying it compiles.
struct Fix {
  std::string message;  // "write `2 x 2`"
  std::vector<Replacement> replacements;
};

struct Diagnostic {
  Code code = Code::P0101;
  Situation situation = Situation::kNone;
  Severity severity = Severity::kError;
  std::string message;
  std::string subject;  // the name that is not known; the same one is missed once
  std::string cause;    // of what is said of tasks: the same one is said of the first
  Span primary;
  std::string primary_label;  // behind the carets; may be empty
  std::vector<Label> labels;
  std::optional<Fix> fix;
  std::vector<std::string> helps;  // a line break continues under the same `= help:`
  std::vector<std::string> notes;

  // For building one in place: diagnostics.report(...).point("...").label(other,
  // "...").help("...").
  Diagnostic& point(std::string text) { return primary_label = std::move(text), *this; }
  // A place that the text does not have (a default, a lost statement) is left out.
  Diagnostic& label(const Span& span, std::string text) {
    if (!span.is_none()) labels.push_back({span, std::move(text), false});
    return *this;
  }
  Diagnostic& also(const Span& span, std::string text) {
    if (!span.is_none()) labels.push_back({span, std::move(text), true});
    return *this;
  }
  Diagnostic& help(std::string text) { return helps.push_back(std::move(text)), *this; }
  Diagnostic& note(std::string text) { return notes.push_back(std::move(text)), *this; }
  // Replaces the bytes of `span` by `replacement`.
  Diagnostic& fix_by(std::string text, const Span& span, std::string replacement) {
    fix = Fix{std::move(text), {{span, std::move(replacement)}}};
    return *this;
  }
};

// What an @allow keeps quiet, with its reason; `about`: the declaration it is about.
struct Silenced {
  Diagnostic diagnostic;
  Span about;
  std::string reason;
};

class Diagnostics {
 public:
  // With the severity of the code's table line. The reference stays valid while the collector
  // lives.
  Diagnostic& report(Code code, const Span& primary, std::string message);
  Diagnostic& report(Situation situation, const Span& primary, std::string message);
  Diagnostic& add(Diagnostic diagnostic);
  void silence(Silenced silenced) { silenced_.push_back(std::move(silenced)); }

  // In constant time: it is asked at every declaration. The severity of a diagnostic is changed, if
  // at all, before kUnsettled others are reported.
  std::size_t error_count() const;
  bool has_errors() const { return error_count() != 0; }
  bool empty() const { return items_.empty(); }
  std::size_t size() const { return items_.size(); }
  Diagnostic& operator[](std::size_t i) { return items_[i]; }  // in the order of reporting
  const std::deque<Diagnostic>& items() const { return items_; }
  const std::vector<Silenced>& silenced() const { return silenced_; }

  // Files in the order they were loaded, then by place; errors and warnings mixed. For printing.
  std::vector<const Diagnostic*> in_source_order() const;

 private:
  static constexpr std::size_t kUnsettled = 64;

  std::deque<Diagnostic> items_;
  std::vector<Silenced> silenced_;
  mutable std::size_t counted_ = 0, counted_errors_ = 0;  // of the first items
};

// The candidate that `name` was probably meant to be, or none: the rule of runtime/base/spelling.h.
std::optional<std::string_view> nearest(std::string_view name,
                                        std::span<const std::string_view> candidates);
// Edits (insert, delete, replace, swap of neighbours) that turn one into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace probe
