#include "compiler/emit/compile.h"

#include <algorithm>
#include <filesystem>

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

Result<Compilation> compile(std::span<const std::string> files, const CompileOptions& options,
                            bool write) {
  if (files.empty()) return Failure{"usage", "no file to compile", ""};
  Compilation compilation;
  Loaded loaded;
  std::vector<std::string> roots;
  for (const std::string& file : files) {
    std::string root = std::filesystem::path(file).lexically_normal().string();
    if (std::find(roots.begin(), roots.end(), root) != roots.end()) continue;
    PROBE_TRY(load(loaded, root, options.library_folders, compilation));
    roots.push_back(std::move(root));
  }
  std::vector<const syntax::File*> trees;
  std::vector<FileId> ids, named;
  for (const syntax::ParseResult& result : loaded.files) {
    trees.push_back(&result.file);
    ids.push_back(result.file.id);
    const std::string& name = compilation.sources.file(result.file.id).name();
    if (std::find(roots.begin(), roots.end(), name) != roots.end()) named.push_back(result.file.id);
  }
  const sema::Model model =
      sema::analyze(compilation.sources, trees, options.asset_root, compilation.diagnostics, named);
  if (!compilation.diagnostics.has_errors()) {
    PROBE_TRY(check_suite_exists(model, options.suite));
    const emit::EmitOptions emit_options{
        options.asset_root, options.suite,
        std::filesystem::path(roots.front()).parent_path().string(), write};
    PROBE_ASSIGN(compilation.plan, emit::emit(model, compilation.sources, ids, emit_options,
                                              compilation.diagnostics));
  }
  compilation.ok = !compilation.diagnostics.has_errors();
  if (!compilation.ok) compilation.plan.clear();
  return compilation;
}

}  // namespace

Result<Compilation> check(std::span<const std::string> files, const CompileOptions& options) {
  return compile(files, options, false);
}

Result<Compilation> build(std::span<const std::string> files, const CompileOptions& options) {
  return compile(files, options, true);
}

}  // namespace probe
