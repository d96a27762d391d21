// What every definition of the analysis shares: the declared names, the tables that are being
// filled, and the way to report. A helper reports its own mistake and answers "nothing", so that
// one mistake gives one message.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/model/model.h"
#include "compiler/names/reporter.h"
#include "compiler/names/symbols.h"
#include "runtime/base/asset_root.h"

namespace probe::sema {

struct Context {
  const SourceSet& sources;
  Reporter& reporter;
  Diagnostics& diagnostics;  // of the reporter
  AssetRoot asset_root;
  Model& model;
  const std::vector<const syntax::File*>& files;  // a file after the files it uses
  const std::vector<FileId>& roots;               // named by the user rather than by `use`
  Symbols symbols = {};

  std::size_t levels = 0;  // open in one another, through predicates or sets: see Level

  std::size_t unread = 0;  // quantities of unknown units, which the lexer reported

  // Grows with every mistake: whether something was wrong between two calls.
  std::size_t mistakes() const { return diagnostics.error_count() + unread; }
  bool has_errors() const { return reporter.has_errors(); }
  // `what`: a Code or a Situation.
  Diagnostic& report(auto what, const Span& span, std::string message) {
    return diagnostics.report(what, span, std::move(message));
  }
};

// The parser bounds the levels of one expression; names that stand for further expressions add up
// to at most this many, in whatever order they are declared.
inline constexpr std::size_t kMaxLevels = 1000;

// One level, while it lives.
class Level {
 public:
  explicit Level(Context& context) : context_(context) { ++context_.levels; }
  ~Level() { --context_.levels; }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

 private:
  Context& context_;
};

// P0103 at the name behind which the levels are too many.
void report_levels(Diagnostics& diagnostics, const Span& name);

}  // namespace probe::sema
