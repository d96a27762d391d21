// P0205: what a file of tasks declares and nothing mentions. A file that others use, or that has no
// tasks of its own, is a library: what it offers need not be used by whoever checks it.
#include <algorithm>
#include <set>
#include <unordered_map>

#include "compiler/check/check.h"
#include "compiler/names/uses.h"

namespace probe::sema {
namespace {

using Counts = std::unordered_map<std::string_view, std::size_t>;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9');
}

// Words of the text and of its strings, where slots name objects; comments do not count.
void count_words(std::string_view text, Counts& counts) {
  bool in_string = false;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' && !(in_string && text[i - 1] == '\\')) in_string = !in_string;
    if (c == '\n') in_string = false;
    if (c == '#' && !in_string) {
      while (i < text.size() && text[i] != '\n') ++i;
      continue;
    }
    if (!is_letter(c)) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < text.size() && is_letter(text[i])) ++i;
    ++counts[text.substr(begin, i - begin)];
  }
}

// A file with attributes or datasets is a catalogue, whatever else stands in it: a vocabulary.
bool declares_tasks(const syntax::File& file) {
  for (const syntax::Decl& decl : file.decls) {
    if (std::holds_alternative<syntax::AttributeDecl>(decl.node) ||
        std::holds_alternative<syntax::DatasetDecl>(decl.node))
      return false;
  }
  for (const syntax::Decl& decl : file.decls) {
    if (std::holds_alternative<syntax::TaskDecl>(decl.node) ||
        std::holds_alternative<syntax::VariantDecl>(decl.node) ||
        std::holds_alternative<syntax::VariantsDecl>(decl.node) ||
        std::holds_alternative<syntax::DeriveDecl>(decl.node) ||
        std::holds_alternative<syntax::SuiteDecl>(decl.node) ||
        std::holds_alternative<syntax::SpaceDecl>(decl.node))
      return true;
  }
  return false;
}

// Phrases may share a name over objects; one mention uses all of them. A `derive` over an axis
// uses every phrase of it.
struct PhraseUse {
  Counts declared;
  std::set<std::string_view> axes;  // of which all phrases are used
};

// So does one over a frame with its templates.
bool is_in_bound_frame(const Checked& checked, const syntax::TemplateDecl& node) {
  for (const auto& derive : checked.symbols.derive_decls) {
    for (const syntax::Binder& binder : derive.node->binders) {
      const auto* templates = std::get_if<syntax::BinderTemplates>(&binder.over);
      if (templates != nullptr && node.frame && templates->frame.text == node.frame->text)
        return true;
    }
  }
  return false;
}

// A set is asked by suites; in a file without one, of all its tasks.
bool is_asked(const Checked& checked, std::string_view name, const syntax::File& file) {
  bool has_suite = false;
  for (const auto& suite : checked.symbols.suite_decls) {
    has_suite = has_suite || suite.file == &file;
    for (const syntax::SuiteStmt& stmt : suite.node->body) {
      const auto* questions = std::get_if<syntax::SuiteQuestionsStmt>(&stmt);
      if (questions == nullptr) continue;
      for (const syntax::Name& asked : questions->sets) {
        if (asked.text == name) return true;
      }
    }
  }
  return !has_suite;
}

PhraseUse phrase_use(const Checked& checked) {
  PhraseUse use;
  const auto count = [&](const std::vector<syntax::ObjectStmt>& body) {
    for (const syntax::ObjectStmt& stmt : body) {
      if (const auto* phrase = std::get_if<syntax::PhraseStmt>(&stmt))
        ++use.declared[phrase->name.text];
    }
  };
  for (const auto& object : checked.symbols.object_decls) count(object.node->body);
  for (const auto& extension : checked.symbols.extend_decls) count(extension.node->body);
  for (const auto& derive : checked.symbols.derive_decls) {
    for (const syntax::Binder& binder : derive.node->binders) {
      if (const auto* phrases = std::get_if<syntax::BinderPhrases>(&binder.over))
        use.axes.insert(phrases->axis.text);
    }
  }
  return use;
}

}  // namespace

void check_unused(const Checked& checked, Reporter& reporter) {
  // A misspelt name would be found twice.
  if (reporter.has_errors()) return;
  std::vector<const syntax::File*> files;
  for (const syntax::File* file : checked.files) {
    const bool is_root = std::any_of(checked.roots.begin(), checked.roots.end(),
                                     [&](FileId id) { return id.value == file->id.value; });
    if (is_root && declares_tasks(*file) && !is_used(checked.files, *file)) files.push_back(file);
  }
  if (files.empty()) return;
  Counts words;
  for (const syntax::File* file : checked.files)
    count_words(checked.sources.file(file->id).text(), words);
  const PhraseUse phrases = phrase_use(checked);
  const auto report = [&](std::string_view kind, const syntax::Name& name) {
    reporter.report(Code::P0205, name.span,
                    std::string(kind) + " `" + std::string(name.text) + "` is never used");
  };
  const auto report_phrases = [&](const std::vector<syntax::ObjectStmt>& body) {
    for (const syntax::ObjectStmt& stmt : body) {
      const auto* phrase = std::get_if<syntax::PhraseStmt>(&stmt);
      if (phrase == nullptr || phrases.axes.contains(phrase->axis.text)) continue;
      const auto declared = phrases.declared.find(phrase->name.text);
      if (words[phrase->name.text] <= declared->second) report("phrase", phrase->name);
    }
  };
  for (const syntax::File* file : files) {
    for (const syntax::Decl& decl : file->decls) {
      if (!decl.complete) continue;
      if (const auto* tmpl = std::get_if<syntax::TemplateDecl>(&decl.node)) {
        // Its own frame may have the same word.
        const std::size_t own = tmpl->frame && tmpl->frame->text == tmpl->name.text ? 2 : 1;
        if (words[tmpl->name.text] <= own && !is_in_bound_frame(checked, *tmpl))
          report("template", tmpl->name);
      } else if (const auto* predicate = std::get_if<syntax::PredicateDecl>(&decl.node)) {
        if (words[predicate->name.text] <= 1) report("predicate", predicate->name);
      } else if (const auto* role = std::get_if<syntax::RoleDecl>(&decl.node)) {
        if (words[role->name.text] <= 1) report("role", role->name);
      } else if (const auto* questions = std::get_if<syntax::QuestionsDecl>(&decl.node)) {
        if (!is_asked(checked, questions->name.text, *file))
          report("set of questions", questions->name);
      } else if (const auto* object = std::get_if<syntax::ObjectDecl>(&decl.node)) {
        if (words[object->name.text] <= 1) report("object", object->name);
        report_phrases(object->body);
      } else if (const auto* extension = std::get_if<syntax::ExtendDecl>(&decl.node)) {
        report_phrases(extension->body);
      }
    }
  }
}

}  // namespace probe::sema
