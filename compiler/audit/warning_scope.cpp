#include "compiler/audit/warning_scope.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

namespace probe::audit {

WarningScope::WarningScope(const Compilation& compilation, const plan::Plan& plan,
                           std::string suite, std::span<const std::uint32_t> tasks)
    : compilation_(compilation), plan_(plan), suite_(std::move(suite)) {
  looked_at_ = with_copied(tasks);
}

bool WarningScope::concerns(const Diagnostic& warning) {
  const auto is_in = [&](bool of_this) {
    return is_in_suite(warning.primary, of_this) ||
           std::ranges::any_of(warning.labels, [&](const Label& label) {
             return is_in_suite(label.span, of_this);
           });
  };
  if (is_in(false) && !is_in(true)) return false;
  for (const syntax::Decl& decl : declarations(warning.primary.file)) {
    if (!is_within(warning.primary, decl.span)) continue;
    const std::vector<std::uint32_t> tasks = tasks_in(decl.span);
    return tasks.empty() || std::ranges::any_of(tasks, [&](std::uint32_t task) {
             return looked_at_.contains(name_of(task));
           });
  }
  return true;
}

std::string WarningScope::name_of(std::uint32_t task) const {
  return std::string(plan_.text(plan_.tasks()[task].name));
}

const std::vector<syntax::Decl>& WarningScope::declarations(FileId file) {
  const auto [known, is_new] = parsed_.try_emplace(file.value);
  if (is_new) {
    Diagnostics again;  // said when it was compiled
    known->second = syntax::parse(compilation_.sources, file, again);
  }
  return known->second.file.decls;
}

// Of each task that is declared as a copy: what it copies.
std::multimap<std::string, std::string> WarningScope::copies() {
  std::multimap<std::string, std::string> from;
  for (std::uint32_t i = 0; i < compilation_.sources.size(); ++i) {
    for (const syntax::Decl& decl : declarations(FileId{i})) {
      if (const auto* const task = std::get_if<syntax::TaskDecl>(&decl.node)) {
        if (task->like) from.emplace(task->name.text, task->like->text);
      } else if (const auto* const variant = std::get_if<syntax::VariantDecl>(&decl.node)) {
        from.emplace(variant->name.text, variant->of.text);
      } else if (const auto* const variants = std::get_if<syntax::VariantsDecl>(&decl.node)) {
        for (const syntax::VariantsMember& member : variants->members)
          from.emplace(member.name.text, variants->of.text);
      }
    }
  }
  return from;
}

std::set<std::string> WarningScope::with_copied(std::span<const std::uint32_t> tasks) {
  const std::multimap<std::string, std::string> from = copies();
  std::set<std::string> names;
  std::vector<std::string> left;
  for (const std::uint32_t task : tasks) left.push_back(name_of(task));
  while (!left.empty()) {
    const std::string name = std::move(left.back());
    left.pop_back();
    if (!names.insert(name).second) continue;
    const auto [begin, end] = from.equal_range(name);
    for (auto it = begin; it != end; ++it) left.push_back(it->second);
    // What is derived has its baseline in the plan alone.
    const auto task = plan_.find_task(name);
    if (task && plan_.tasks()[*task].baseline != plan::kNone)
      left.push_back(name_of(plan_.tasks()[*task].baseline));
  }
  return names;
}

// Whether a place is in the declaration of a suite: of this one, or of another.
bool WarningScope::is_in_suite(const Span& at, bool of_this) {
  if (at.is_none()) return false;
  return std::ranges::any_of(declarations(at.file), [&](const syntax::Decl& decl) {
    const auto* const suite = std::get_if<syntax::SuiteDecl>(&decl.node);
    return suite != nullptr && is_within(at, decl.span) && (suite->name.text == suite_) == of_this;
  });
}

// The tasks whose names stand in a declaration.
std::vector<std::uint32_t> WarningScope::tasks_in(const Span& declaration) const {
  const std::string_view text = compilation_.sources.file(declaration.file).text();
  std::vector<std::uint32_t> found;
  for (std::uint32_t task = 0; task < plan_.tasks().size(); ++task) {
    const plan::SpanRecord* span = plan_.span_of(plan::SpanKind::kTasks, task);
    if (span == nullptr || span->begin < declaration.begin || span->begin >= declaration.end)
      continue;
    if (plan_.tables().source(plan_.texts()[span->text]) == text) found.push_back(task);
  }
  return found;
}

}  // namespace probe::audit
