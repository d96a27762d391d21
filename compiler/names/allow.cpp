#include "compiler/names/allow.h"

#include <algorithm>
#include <tuple>

#include "compiler/names/texts.h"

namespace probe::sema {
namespace {

// What is about tasks may be said of each at one place, such as a layout they share. Written tasks
// are few and their names matter; a `derive` makes thousands.
constexpr std::size_t kSaidOfOnePlace = 3;

struct Allowed {
  const syntax::Allow* allow = nullptr;
  Code code{};
  Span decl;
  bool used = false;
};

std::vector<Allowed> collect_allows(const Context& context) {
  std::vector<Allowed> allows;
  for (const syntax::File* file : context.files) {
    for (const syntax::Decl& decl : file->decls) {
      for (const syntax::Allow& allow : decl.allows) {
        if (const auto code = code_from_slug(allow.what.text))
          allows.push_back({&allow, *code, allow.member.is_none() ? decl.span : allow.member});
      }
    }
  }
  return allows;
}

// The @allow that keeps it quiet; null when it is said.
const syntax::Allow* silencer(const Context& context, const Diagnostic& diagnostic,
                              std::size_t index, std::vector<Allowed>& allows) {
  if (diagnostic.severity != Severity::kWarning) return nullptr;
  const auto about = context.reporter.about.find(index);
  const syntax::Allow* found = nullptr;
  for (Allowed& allowed : allows) {
    if (allowed.code != diagnostic.code) continue;
    const bool here =
        is_within(diagnostic.primary, allowed.decl) ||
        (about != context.reporter.about.end() && is_within(about->second, allowed.decl));
    allowed.used = allowed.used || here;
    if (here) found = allowed.allow;
  }
  return found;
}

// Within a declaration that could only be read in part: what is found there is found of a torso.
bool is_in_torso(const Context& context, const Span& span) {
  for (const syntax::File* file : context.files) {
    if (file->id != span.file) continue;
    for (const syntax::Decl& decl : file->decls) {
      if (!decl.complete && is_within(span, decl.span)) return true;
    }
  }
  return false;
}

bool is_in_derive(const Context& context, const Span& span) {
  return std::any_of(context.symbols.derive_decls.begin(), context.symbols.derive_decls.end(),
                     [&](const auto& declared) { return is_within(span, declared.decl->span); });
}

}  // namespace

void note_more(Diagnostic& said, std::size_t tasks) {
  said.note("the same holds for " + std::to_string(tasks) + " more task" + (tasks == 1 ? "" : "s"));
}

void check_allows(const std::vector<const syntax::File*>& files, Diagnostics& diagnostics) {
  std::vector<std::string_view> words;
  for (const Code code : all_codes()) {
    if (!info(code).slug.empty()) words.push_back(info(code).slug);
  }
  for (const syntax::File* file : files) {
    for (const syntax::Decl& decl : file->decls) {
      for (const syntax::Allow& allow : decl.allows) {
        check_text(diagnostics, spelled(allow.reason), "the reason");
        if (allow.what.text.empty() || code_from_slug(allow.what.text)) continue;
        Diagnostic& unknown = diagnostics.report(
            Code::P0208, allow.what.span,
            "`" + std::string(allow.what.text) + "` is nothing that can be allowed");
        const auto near = nearest(allow.what.text, words);
        if (!near) continue;
        unknown.point("did you mean `" + std::string(*near) + "`?")
            .fix_by("write `" + std::string(*near) + "`", allow.what.span, std::string(*near));
      }
    }
  }
}

void say(const Context& context, std::span<const FileId> roots, bool lacks_names,
         Diagnostics& out) {
  std::vector<Allowed> allows = collect_allows(context);
  struct Said {
    std::size_t count = 0;
    std::size_t limit = kSaidOfOnePlace;
    Diagnostic* last = nullptr;
  };
  std::map<std::tuple<Code, std::uint32_t, std::uint32_t, std::uint32_t>, Said> places;
  // A name that is declared nowhere is missed once, however often it is used.
  std::map<std::string, Said> unknown;
  std::map<std::pair<Code, std::string>, Said> causes;
  std::size_t index = 0;
  for (const Diagnostic& diagnostic : context.diagnostics.items()) {
    const std::size_t at = index++;
    if (const syntax::Allow* allow = silencer(context, diagnostic, at, allows)) {
      const auto about = context.reporter.about.find(at);
      out.silence({diagnostic, about == context.reporter.about.end() ? Span{} : about->second,
                   allow->reason.value});
      continue;
    }
    // What could not be read may declare it; a near spelling is a mistake all the same.
    if (context.reporter.was_broken && is_in_torso(context, diagnostic.primary)) continue;
    const bool is_unknown = diagnostic.code == Code::P0201 || diagnostic.code == Code::P0204;
    if (lacks_names && is_unknown && !diagnostic.fix) continue;
    if (!diagnostic.subject.empty()) {
      Said& name = unknown[diagnostic.subject];
      if (name.count++ == 0) {
        name.last = &out.add(diagnostic);
      } else if (name.last->fix && diagnostic.fix) {
        const auto& more = diagnostic.fix->replacements;
        name.last->fix->replacements.insert(name.last->fix->replacements.end(), more.begin(),
                                            more.end());
      }
      continue;
    }
    if (!diagnostic.cause.empty()) {
      Said& cause = causes[{diagnostic.code, diagnostic.cause}];
      if (cause.count++ == 0) cause.last = &out.add(diagnostic);
      continue;
    }
    if (!context.reporter.about.contains(at)) {
      out.add(diagnostic);
      continue;
    }
    const Span& span = diagnostic.primary;
    Said& place = places[{diagnostic.code, span.file.value, span.begin, span.end}];
    if (place.count == 0 && is_in_derive(context, span)) place.limit = 1;
    if (++place.count <= place.limit) place.last = &out.add(diagnostic);
  }
  for (auto& [key, place] : places) {
    if (place.count > place.limit) note_more(*place.last, place.count - place.limit);
  }
  for (auto& [key, cause] : causes) {
    if (cause.count > 1) note_more(*cause.last, cause.count - 1);
  }
  for (auto& [subject, name] : unknown) {
    if (name.count > 1)
      name.last->note("so it is named at " + std::to_string(name.count - 1) + " more place" +
                      (name.count > 2 ? "s" : ""));
  }
  // A mistake elsewhere, or what was not looked at, may be why there is nothing to silence.
  if (context.has_errors() || context.reporter.depth.is_immediate) return;
  for (const Allowed& allowed : allows) {
    const bool is_root = std::any_of(roots.begin(), roots.end(), [&](FileId id) {
      return id.value == allowed.allow->span.file.value;
    });
    if (allowed.used || !is_root) continue;
    out.report(Code::P0209, allowed.allow->span,
               "`@allow(" + std::string(allowed.allow->what.text) + ")` silences nothing");
  }
}

}  // namespace probe::sema
