#include "compiler/emit/compile.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/emit/emit.h"
#include "compiler/sema/analyze.h"
#include "compiler/syntax/parser.h"

namespace probe {
namespace {

// All files that the roots reach, each once, a file after those it uses.
struct Loaded {
  std::vector<syntax::ParseResult> files;
  bool ok = true;

  bool has(FileId id) const {
    return std::any_of(files.begin(), files.end(),
                       [&](const auto& known) { return known.file.id == id; });
  }
};

Status load(Loaded& loaded, const std::string& root, const std::vector<std::string>& folders,
            Compilation& compilation) {
  // What two roots share is parsed again by the second; its messages have been given already.
  Diagnostics diagnostics;
  PROBE_ASSIGN(syntax::Program program,
               syntax::load_program(compilation.sources, root, folders, diagnostics));
  for (const Diagnostic& diagnostic : diagnostics.items()) {
    if (!loaded.has(diagnostic.primary.file)) compilation.diagnostics.add(diagnostic);
  }
  loaded.ok = loaded.ok && program.ok;
  for (syntax::ParseResult& result : program.files) {
    if (!loaded.has(result.file.id)) loaded.files.push_back(std::move(result));
  }
  return {};
}

Status check_suite_exists(const sema::Model& model, const std::string& suite) {
  if (suite.empty()) return {};
  std::vector<std::string_view> names;
  std::string known;
  for (const sema::Suite& candidate : model.suites) {
    if (candidate.name == suite) return {};
    names.push_back(candidate.name);
    known += (known.empty() ? "`" : ", `") + candidate.name + "`";
  }
  std::string message = "unknown suite `" + suite + "`";
  if (const auto near = nearest(suite, names)) {
    message += ", did you mean `" + std::string(*near) + "`?";
  } else {
    message += known.empty() ? ", the files declare none" : ", the files declare " + known;
  }
  return Failure{"usage", message, ""};
}

// Everything but the bytes. The model's spans point into `compilation.sources`.
struct Analyzed {
  Compilation compilation;
  std::vector<std::string> roots;
  Loaded loaded;
  std::vector<FileId> ids;
  sema::Model model;
};

std::vector<std::string> unused_phrases(const sema::Model& model) {
  std::set<std::pair<sema::ObjectId, std::string>> used;
  std::set<sema::ObjectId> objects;
  for (const sema::Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    for (const sema::ObjectId object : task.objects()) objects.insert(object);
    if (task.refer[0]) used.emplace(task.source, task.refer[0]->text);
    if (task.refer[1]) used.emplace(task.target, task.refer[1]->text);
  }
  std::vector<std::string> names;
  for (const sema::ObjectId object : objects) {
    for (const sema::Phrase& phrase : model.objects[object].phrases) {
      if (!used.contains({object, phrase.name}))
        names.push_back(model.objects[object].name + "." + phrase.name);
    }
  }
  return names;
}

Status analyze(std::span<const std::string> files, const CompileOptions& options, Analyzed& out) {
  if (files.empty()) return Failure{"usage", "no file to compile", ""};
  for (const std::string& file : files) {
    std::string root = std::filesystem::path(file).lexically_normal().string();
    if (std::find(out.roots.begin(), out.roots.end(), root) != out.roots.end()) continue;
    PROBE_TRY(load(out.loaded, root, options.library_folders, out.compilation));
    out.roots.push_back(std::move(root));
  }
  std::vector<const syntax::File*> trees;
  std::vector<FileId> named;
  for (const syntax::ParseResult& result : out.loaded.files) {
    trees.push_back(&result.file);
    out.ids.push_back(result.file.id);
    const std::string& name = out.compilation.sources.file(result.file.id).name();
    if (std::find(out.roots.begin(), out.roots.end(), name) != out.roots.end())
      named.push_back(result.file.id);
  }
  out.model = sema::analyze(out.compilation.sources, trees, options.asset_root,
                            out.compilation.diagnostics, named);
  for (const sema::Object& object : out.model.objects)
    out.compilation.called.emplace(object.name, object.text.text);
  out.compilation.unused_phrases = unused_phrases(out.model);
  const auto behind_used = std::stable_partition(
      out.model.suites.begin(), out.model.suites.end(), [&](const sema::Suite& suite) {
        return std::find(named.begin(), named.end(), suite.span.file) != named.end();
      });
  for (auto suite = out.model.suites.begin(); suite != behind_used; ++suite)
    out.compilation.own_suites.push_back(suite->name);
  out.compilation.ok = !out.compilation.diagnostics.has_errors();
  if (out.compilation.ok) PROBE_TRY(check_suite_exists(out.model, options.suite));
  return {};
}

Result<Compilation> compile(std::span<const std::string> files, const CompileOptions& options,
                            bool write) {
  Analyzed analyzed;
  PROBE_TRY(analyze(files, options, analyzed));
  Compilation& compilation = analyzed.compilation;
  if (compilation.ok) {
    const emit::EmitOptions emit_options{
        options.asset_root, options.suite,
        std::filesystem::path(analyzed.roots.front()).parent_path().string(), write};
    PROBE_ASSIGN(compilation.plan, emit::emit(analyzed.model, compilation.sources, analyzed.ids,
                                              emit_options, compilation.diagnostics));
  }
  compilation.ok = !compilation.diagnostics.has_errors();
  if (!compilation.ok) compilation.plan.clear();
  return std::move(compilation);
}

}  // namespace

Result<Compilation> check(std::span<const std::string> files, const CompileOptions& options) {
  return compile(files, options, false);
}

Result<Compilation> build(std::span<const std::string> files, const CompileOptions& options) {
  return compile(files, options, true);
}

Result<Counted> count(std::span<const std::string> files, const CompileOptions& options) {
  Analyzed analyzed;
  PROBE_TRY(analyze(files, options, analyzed));
  Counts counts;
  const auto add = [&](const sema::Task& task) {
    if (task.abstract || !task.complete) return;
    ++counts.tasks;
    counts.episodes += task.starts.size();
  };
  if (options.suite.empty()) {
    for (const sema::Task& task : analyzed.model.tasks) add(task);
  }
  for (const sema::Suite& suite : analyzed.model.suites) {
    if (options.suite.empty() || suite.name != options.suite) continue;
    for (const sema::TaskId id : suite.members) add(analyzed.model.tasks[id]);
  }
  return Counted{std::move(analyzed.compilation), counts};
}

}  // namespace probe
