#include "compiler/language/hover.h"

#include <algorithm>

#include "compiler/diag/essays.h"
#include "compiler/language/hints.h"
#include "compiler/language/signature.h"
#include "compiler/model/measures.h"

namespace probe::language {
namespace {

constexpr std::size_t kMostLines = 14;

// Its lines up to so many, without the indentation that they share with the first.
std::string cut_lines(std::string_view text) {
  std::string out;
  std::size_t lines = 0;
  while (!text.empty() && lines < kMostLines) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    out += std::string(line) + "\n";
    text.remove_prefix(std::min(end + 1, text.size()));
    ++lines;
  }
  return text.empty() ? out : out + "...\n";
}

// A fence that no text of a file can end: it holds no longer run of marks.
std::string fenced(std::string_view text) {
  std::size_t longest = 0, run = 0;
  for (const char c : text) longest = std::max(longest, run = c == '`' ? run + 1 : 0);
  const std::string fence(std::max<std::size_t>(3, longest + 1), '`');
  return fence + "probe\n" + cut_lines(text) + fence + "\n";
}

std::string essay_of(Code code) {
  return "**" + std::string(info(code).text) + "** " + std::string(info(code).title) + "\n\n" +
         std::string(essay(code)) + "\n";
}

std::string of_task(const Snapshot& snapshot, const sema::Task& task) {
  if (task.abstract) return "abstract: copied by `like`, never run\n";
  if (!task.complete) return {};
  const sema::Model& model = snapshot.model();
  std::string text = "\"" + task.prompt + "\"\n\n" + starts_text(task) + ", " +
                     std::to_string(task.horizon) + " steps";
  if (task.baseline != sema::TaskId::kNone)
    text += "; against `" + model.tasks[task.baseline].name + "`: " + axes_text(task);
  text += "\n\n";
  for (const sema::ObjectId id : task.objects()) {
    const sema::RoleId role = task.role_of(id);
    const std::string as =
        role == sema::RoleId::kNone ? "beside them" : model.roles[role].name;
    text += "- " + as + ": `" + model.objects[id].name + "`\n";
  }
  return text;
}

std::string of_object(const sema::Object& object) {
  if (object.broken) return {};
  std::string text = "called \"" + object.text.text + "\"";
  if (!object.phrases.empty()) text += "; phrases:";
  text += "\n";
  for (const sema::Phrase& phrase : object.phrases)
    text += "- `" + phrase.name + "`: \"" + phrase.text.text + "\" means " + phrase.means_text + "\n";
  return text;
}

// What the model adds to the text of a declaration.
std::string meaning(const Snapshot& snapshot, const Symbol& symbol) {
  const sema::Model& model = snapshot.model();
  switch (symbol.kind) {
    case Kind::kTask:
      if (const sema::Task* task = snapshot.task(symbol.name)) return of_task(snapshot, *task);
      return {};
    case Kind::kObject:
      for (const sema::Object& object : model.objects) {
        if (object.name == symbol.name) return of_object(object);
      }
      return {};
    case Kind::kSet:
      for (const sema::TaskSet& set : model.sets) {
        if (set.name == symbol.name)
          return std::to_string(set.members.size()) + " tasks\n";
      }
      return {};
    case Kind::kMeasure:
      if (const auto signature = signature_of(snapshot, symbol.name))
        return "`" + signature->label + "`: " + signature->documentation + "\n";
      return {};
    case Kind::kRole:
      if (symbol.name == "source") return "the object that the task is about\n";
      if (symbol.name == "target") return "where, or to what, it goes\n";
      return {};
    default:
      return {};
  }
}

const syntax::Decl* decl_of(const Snapshot& snapshot, const Span& span) {
  const syntax::ParseResult* parsed = snapshot.tree(span.file);
  if (parsed == nullptr) return nullptr;
  for (const syntax::Decl& decl : parsed->file.decls) {
    if (is_within(span, decl.span)) return &decl;
  }
  return nullptr;
}

std::optional<Hover> of_number(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  for (const sema::WantedNumber& number : snapshot.wanted_numbers()) {
    const Span& span = number.span;
    if (!(span.file == file) || offset < span.begin || offset > span.end) continue;
    return Hover{span, name_of(number.dimension) +
                           (number.takes.empty() ? "" : ": " + number.takes) + "\n"};
  }
  return std::nullopt;
}

std::optional<Hover> of_allow(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  const syntax::ParseResult* parsed = snapshot.tree(file);
  for (const syntax::Decl& decl : parsed->file.decls) {
    for (const syntax::Allow& allow : decl.allows) {
      const Span& span = allow.what.span;
      if (offset < span.begin || offset > span.end) continue;
      if (const auto code = code_from_slug(allow.what.text)) return Hover{span, essay_of(*code)};
    }
  }
  return std::nullopt;
}

// A derived task is declared by nobody's name.
const sema::Task* derived_task(const Snapshot& snapshot, const Place& place) {
  if (!place.may_be.has(Kind::kTask)) return nullptr;
  const sema::Task* task = snapshot.task(place.text);
  return task != nullptr && task->derived ? task : nullptr;
}

}  // namespace

std::string declaration_text(const Snapshot& snapshot, const Place& declaration) {
  const Span& whole = declaration.whole.is_none() ? declaration.span : declaration.whole;
  std::string text = fenced(snapshot.sources().text(whole));
  const syntax::Decl* decl = decl_of(snapshot, whole);
  if (decl == nullptr || !(decl->span == whole)) return text;
  for (const std::string_view line : decl->docs) text += "\n" + std::string(line);
  return decl->docs.empty() ? text : text + "\n";
}

std::optional<Hover> hover(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                           const std::vector<const Diagnostic*>& said) {
  if (snapshot.tree(file) == nullptr) return std::nullopt;
  std::optional<Hover> out;
  const Place* place = snapshot.index().at(file, offset);
  if (place != nullptr) {
    if (const auto symbol = snapshot.index().symbol(*place)) {
      out = Hover{place->span, ""};
      // Of many of one name, as of a phrase, a few.
      constexpr std::size_t kMost = 3;
      std::size_t shown = 0;
      for (const Place* declared : snapshot.index().declarations(*symbol)) {
        if (shown++ == kMost) break;
        out->text += declaration_text(snapshot, *declared);
      }
      if (shown == 0)
        out->text += std::string(info(symbol->kind).word) + " `" + symbol->name + "`\n";
      const std::string more = meaning(snapshot, *symbol);
      if (!more.empty()) out->text += "\n" + more;
    } else if (const sema::Task* task = derived_task(snapshot, *place)) {
      out = Hover{place->span, fenced(snapshot.sources().text(task->decl_span)) + "\n" +
                                   of_task(snapshot, *task)};
    }
  }
  if (!out) out = of_number(snapshot, file, offset);
  if (!out) out = of_allow(snapshot, file, offset);
  for (const Diagnostic* diagnostic : said) {
    const Span& span = diagnostic->primary;
    if (!(span.file == file) || offset < span.begin || offset > span.end) continue;
    if (!out) out = Hover{span, ""};
    if (out->text.find(essay_of(diagnostic->code)) == out->text.npos)
      out->text += (out->text.empty() ? "" : "\n---\n") + essay_of(diagnostic->code);
  }
  return out;
}

std::vector<Span> definitions(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  std::vector<Span> out;
  const syntax::ParseResult* parsed = snapshot.tree(file);
  if (parsed == nullptr) return out;
  for (const syntax::Decl& decl : parsed->file.decls) {
    const auto* use = std::get_if<syntax::UseDecl>(&decl.node);
    if (use == nullptr || use->file.is_none()) continue;
    const Span& span = use->path.span;
    if (span.begin <= offset && offset <= span.end) return {{use->file, 0, 0}};
  }
  const Place* place = snapshot.index().at(file, offset);
  if (place == nullptr) return out;
  const auto symbol = snapshot.index().symbol(*place);
  if (!symbol) {
    if (const sema::Task* task = derived_task(snapshot, *place)) out.push_back(task->span);
    return out;
  }
  // Whose phrase or part it is: the object that fills the role in this task, else the owner named.
  std::vector<std::string_view> owners;
  if (!place->of.empty()) owners.push_back(place->of);
  for (const Place& declared : snapshot.index().places(file)) {
    if (place->of.empty() || !declared.declares || !declared.may_be.has(Kind::kTask)) continue;
    if (!is_within(place->span, declared.whole)) continue;
    const sema::Task* task = snapshot.task(declared.text);
    if (task == nullptr) continue;
    for (const sema::ObjectId id : task->objects()) {
      const sema::RoleId role = task->role_of(id);
      if (role != sema::RoleId::kNone && snapshot.model().roles[role].name == place->of)
        owners.push_back(snapshot.model().objects[id].name);
    }
  }
  std::vector<Span> others;
  for (const Place* declared : snapshot.index().declarations(*symbol)) {
    const bool is_own = std::ranges::find(owners, declared->of) != owners.end();
    (is_own && !declared->of.empty() ? out : others).push_back(declared->span);
  }
  return out.empty() ? others : out;
}

}  // namespace probe::language
