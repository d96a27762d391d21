// What is said of questions that have no single right answer, once for each place of a text.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "compiler/names/context.h"
#include "runtime/plan/questions.h"

namespace probe::sema {

// Questions without a single right answer, or without what they want, said of the first task of
// each place alone.
class Ambiguities {
 public:
  explicit Ambiguities(Context& context) : context_(context) {}
  ~Ambiguities() {
    for (const auto& [place, said] : said_) {
      if (said.count > 1)
        said.first->note("the same holds for " + std::to_string(said.count - 1) + " more " +
                         (said.count > 2 ? "questions" : "question"));
    }
  }
  Ambiguities(const Ambiguities&) = delete;
  Ambiguities& operator=(const Ambiguities&) = delete;

  // Only a warning can be silenced; the question is then left out of such tasks.
  plan::OmissionReason report(Code code, const Span& span, bool is_allowed,
                              const std::string& message, const char* slug) {
    Said& said = said_[{code, span.file.value, span.begin, span.end}];
    if (said.count++ == 0) {
      said.first = &context_.report(code, span, message);
      if (is_allowed) said.first->severity = Severity::kWarning;
      said.first->help(
          "keep the question from such tasks by `where`, or leave it out of them with "
          "`@allow(" +
          std::string(slug) + ", \"...\")` above the set");
    }
    return plan::OmissionReason::kAmbiguous;
  }

  // What is as good as can be had, and is to be known.
  void tell(Code code, const Span& span, const std::string& message) {
    Said& said = said_[{code, span.file.value, span.begin, span.end}];
    if (said.count++ == 0) said.first = &context_.report(code, span, message);
  }

 private:
  struct Said {
    Diagnostic* first = nullptr;
    std::size_t count = 0;
  };
  Context& context_;
  std::map<std::tuple<Code, std::uint32_t, std::uint32_t, std::uint32_t>, Said> said_;
};

}  // namespace probe::sema
