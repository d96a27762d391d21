// Which of the compiler's warnings concern the suite that an audit looks at: a text may declare
// other suites, and tasks that this one does not hold.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "compiler/syntax/parser.h"
#include "runtime/plan/plan.h"

namespace probe::audit {

class WarningScope {
 public:
  // `tasks`: those that are looked at. Compilation and plan must live as long.
  WarningScope(const Compilation& compilation, const plan::Plan& plan, std::string suite,
               std::span<const std::uint32_t> tasks);

  // Does not hold of what is said about another suite, nor of what is said in a declaration of
  // tasks none of which is looked at, or copied by one that is.
  bool concerns(const Diagnostic& warning);

 private:
  std::string name_of(std::uint32_t task) const;
  const std::vector<syntax::Decl>& declarations(FileId file);
  std::multimap<std::string, std::string> copies();
  std::set<std::string> with_copied(std::span<const std::uint32_t> tasks);
  bool is_in_suite(const Span& at, bool of_this);
  std::vector<std::uint32_t> tasks_in(const Span& declaration) const;

  const Compilation& compilation_;
  const plan::Plan& plan_;
  const std::string suite_;
  std::map<std::uint32_t, syntax::ParseResult> parsed_;  // by FileId
  // The names of the tasks that are looked at and of all that these copy: what is said of a copied
  // statement has its place where that is written.
  std::set<std::string> looked_at_;
};

}  // namespace probe::audit
