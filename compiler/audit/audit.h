// What is irregular in a suite: comparisons that move more than one thing, judges that differ,
// words for what is not there, rules that pass what they should not. Diagnostics say what is wrong
// with a text; an audit says what a reader of its results has to know, allowed or not.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/audit/robots.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"

namespace probe::audit {

// In the order of the report.
enum class Kind : std::uint8_t {
  kConfounded,
  kAcrossScenes,
  kAcrossLayouts,
  kHorizon,
  kSuccessRule,
  kUnlisted,
  kDuplicate,
  kSamePrompt,
  kNamesake,
  kWrongCountsTarget,
  kWrongAtEnd,
  kEndsInGrasp,
  kBeside,
  kOnFixture,
  kHeld,
  kInTheAir,
  kTouchedOnce,
  kHoldsAtStart,
  kSwappedOrder,
  kSolution,
  kFallsOn,
  kUnfelt,
  kNamesAnswer,
  kOneAnswer,
  kOneLetter,
  kCoin,
  kTable,
  kWarning
};
// As in JSON ("success_rule"), and the heading of the report.
std::string_view name(Kind kind);
std::string_view title(Kind kind);

struct Place {
  std::string file;  // empty: nowhere in particular
  std::uint32_t line = 0, column = 0;
};

struct Finding {
  Kind kind = Kind::kConfounded;
  std::string code;                // of kWarning: "absent", "out_of_frame", the word of @allow
  std::vector<std::string> tasks;  // whom it concerns; a rule concerns many
  std::string baseline;            // of a comparison
  std::vector<std::string> axes;   // of a comparison
  std::string message;
  Place place;
  std::optional<std::string> allowed;  // the reason of an @allow
};

// Words of instructions that nothing is held to.
struct Unheld {
  std::string words, why;
  std::vector<std::string> tasks;  // that say them
  Place place;                     // of the first
};

struct Audit {
  std::string suite;
  std::size_t tasks = 0, comparisons = 0;  // of the suite
  std::vector<Finding> findings;           // by kind, then in the order of the text
  std::vector<RobotFacts> robots;
  std::vector<Unheld> unheld;  // in the order of the tasks; empty of a compilation without them
  std::size_t held = 0, heard = 0;  // tasks all of whose words are held to success, of how many
  // Tasks whose success was put to the test in made-up worlds; those of which it is not known how it
  // is come by, where several things are put somewhere, and which were not.
  std::size_t starts = 0, repeated = 0;  // that an earlier start of the same task equals
  std::size_t tried = 0;
  std::vector<std::string> untried;
  std::vector<std::string> unchecked;  // columns of a published table that are no set
};

// `plan` is that of `compilation`, with all its suites; `suite` indexes plan.suites(). `files` are
// those that were named: comparisons that they declare and no suite holds are findings too.
// A Failure (kJudge) is a plan that cannot be judged.
Result<Audit> audit(const Compilation& compilation, const plan::Plan& plan, std::uint32_t suite,
                    std::span<const std::string> files);

std::string to_text(const Audit& audit);
std::string to_json(const Audit& audit);

}  // namespace probe::audit
