// What the analysis has to say, with the declaration that each word is about: what every check gets
// beside the model.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/units.h"

namespace probe::sema {

// What a statement takes where a number stands.
struct WantedNumber {
  Span span;
  Dimension dimension;
  std::string takes;  // "`density` takes a density"
};

class Remembered;  // define/remembered.h

// How far a text is looked at: whole, or while it is being typed.
struct Depth {
  bool is_immediate = false;                  // without reach, travels and the boxes of meshes
  const std::atomic<bool>* stop = nullptr;    // once it is true, nothing more is worth finding
  std::vector<WantedNumber>* wants = nullptr;  // where to keep what every number should measure
  Remembered* remembered = nullptr;            // of the text before this one, while it is typed
};

struct Reporter {
  Diagnostics& diagnostics;
  bool was_broken = false;  // the text had errors before: what lacks now may follow from them
  std::map<std::size_t, Span> about = {};  // by diagnostic: the declaration it is about
  Depth depth = {};

  bool is_stopped() const { return depth.stop != nullptr && depth.stop->load(); }

  bool has_errors() const { return was_broken || diagnostics.has_errors(); }
  // `what`: a Code or a Situation.
  Diagnostic& report(auto what, const Span& span, std::string message) {
    return diagnostics.report(what, span, std::move(message));
  }
};

// While it lives, what is reported is about this declaration, wherever it points: an @allow there
// silences it.
class About {
 public:
  About(Reporter& reporter, const Span& decl)
      : reporter_(reporter), decl_(decl), first_(reporter.diagnostics.size()) {}
  ~About() {
    for (std::size_t i = first_; i < reporter_.diagnostics.size(); ++i)
      reporter_.about.insert({i, decl_});
  }
  About(const About&) = delete;
  About& operator=(const About&) = delete;

 private:
  Reporter& reporter_;
  Span decl_;
  std::size_t first_;
};

}  // namespace probe::sema
