#include "compiler/emit/compile.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "compiler/check/analyze.h"
#include "compiler/check/held.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"
#include "compiler/emit/analyzed.h"
#include "compiler/emit/early_end.h"
#include "compiler/emit/emit.h"
#include "compiler/syntax/parser.h"

namespace probe {
namespace {

// Of more starts the judge is not asked in made-up worlds while a text is checked or built.
constexpr std::size_t kMostStartsJudged = 20'000;

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
  return Failure{Fault::kUsage, message, ""};
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
    for (const auto& [role, refer] : task.refer) {
      for (const sema::ObjectId object : task.objects_in(role)) used.emplace(object, refer.text);
    }
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

// Roles that the instruction does not mention have no words in it.
std::vector<ReferringWords> referring_words(const sema::Model& model) {
  std::vector<ReferringWords> all;
  for (const sema::Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    for (const sema::ObjectId object : task.objects()) {
      if (task.role_of(object) == sema::RoleId::kNone) continue;
      const sema::Referring said = sema::referring(model, task, object);
      if (said.text == nullptr || sema::whole_prompt(task).find(*said.text) == std::string::npos) continue;
      all.push_back({task.name, *said.text, model.objects[object].name, said.phrase != nullptr});
    }
  }
  return all;
}

std::vector<ChosenStarts> chosen_starts(const sema::Model& model) {
  std::vector<ChosenStarts> all;
  for (const sema::Task& task : model.tasks) {
    if (task.abstract || task.clear.empty() || task.starts.empty()) continue;
    all.push_back({task.name, task.starts.size(), task.layout_starts});
  }
  return all;
}

Status analyze(std::span<const std::string> files, const CompileOptions& options, Analyzed& out) {
  if (files.empty()) return Failure{Fault::kUsage, "no file to compile", ""};
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
  // Files that the program has itself come first, then those that it uses.
  std::vector<std::string> texts = out.roots;
  for (const FileId id : out.ids) texts.push_back(out.compilation.sources.file(id).name());
  out.compilation.asset_root = options.asset_root.beside(texts);
  out.model = sema::analyze(out.compilation.sources, trees, out.compilation.asset_root,
                            out.compilation.diagnostics, named, {.stop = options.stop});
  out.compilation.unused_phrases = unused_phrases(out.model);
  out.compilation.referring = referring_words(out.model);
  out.compilation.chosen = chosen_starts(out.model);
  for (const sema::Object& object : out.model.objects)
    out.compilation.called.emplace(object.name, object.text.text);
  sema::Callings callings(out.model);
  for (const sema::Task& task : out.model.tasks) {
    if (!options.wants_unheld || task.abstract || !task.complete) continue;
    for (sema::NotHeld& one : sema::not_held(out.model, task, callings))
      out.compilation.unheld.push_back({task.name, std::move(one.words), std::move(one.why)});
  }
  const auto behind_used = std::stable_partition(
      out.model.suites.begin(), out.model.suites.end(), [&](const sema::Suite& suite) {
        return std::find(named.begin(), named.end(), suite.span.file) != named.end();
      });
  for (auto suite = out.model.suites.begin(); suite != behind_used; ++suite)
    out.compilation.own_suites.push_back(suite->name);
  for (const sema::Task& task : out.model.tasks) {
    if (task.abstract || !task.complete) continue;
    ++out.compilation.tasks;
    out.compilation.starts += task.starts.size();
  }
  out.compilation.ok = !out.compilation.diagnostics.has_errors();
  if (out.compilation.ok) PROBE_TRY(check_suite_exists(out.model, options.suite));
  return {};
}

// A file is known by its path before it is read.
SourceSet with_unsaved(const CompileOptions& options) {
  SourceSet sources;
  for (const auto& [path, text] : options.unsaved) sources.add(path, text);
  return sources;
}

// Which programs become bytes, and for whom.
struct WantedPlan {
  bool is_wanted = false;
  bool is_kept = false;         // else only looked at, and not proven once more
  std::size_t most_starts = 0;  // of one that is not kept
};

// `sources`: files that are known already.
Result<Compilation> compile(std::span<const std::string> files, const CompileOptions& options,
                            WantedPlan plan, SourceSet sources,
                            emit::AssetHashes* hashed = nullptr) {
  Analyzed analyzed;
  analyzed.compilation.sources = std::move(sources);
  PROBE_TRY(analyze(files, options, analyzed));
  Compilation& compilation = analyzed.compilation;
  const bool asks_judge =
      compilation.starts <= kMostStartsJudged && emit::may_end_early(analyzed.model);
  const bool write =
      (plan.is_wanted && (plan.is_kept || compilation.starts <= plan.most_starts)) || asks_judge;
  const bool is_stopped = options.stop != nullptr && options.stop->load();
  if (compilation.ok && !is_stopped) {
    const emit::EmitOptions emit_options{
        .asset_root = compilation.asset_root,
        .suite = options.suite,
        .source_folder = std::filesystem::path(analyzed.roots.front()).parent_path().string(),
        .write = write,
        .inspect_asset = options.inspect_asset,
        .wants_task = options.wants_task,
        .proves = plan.is_kept,
        .hashed = hashed};
    PROBE_ASSIGN(compilation.plan, emit::emit(analyzed.model, compilation.sources, analyzed.ids,
                                              emit_options, compilation.diagnostics));
    if (asks_judge && !compilation.plan.empty())
      PROBE_TRY(emit::note_early_ends(analyzed.model, compilation.plan, compilation.diagnostics));
  }
  compilation.ok = !compilation.diagnostics.has_errors();
  if (!compilation.ok || !plan.is_wanted) compilation.plan.clear();
  return std::move(compilation);
}

// One program of those that are checked; its plan goes to whoever asked for it.
Result<Compilation> check_program(const std::string& root, const CompileOptions& options,
                                  SourceSet sources, emit::AssetHashes& hashed) {
  const WantedPlan plan{static_cast<bool>(options.plans.take), false, options.plans.most_starts};
  PROBE_ASSIGN(Compilation program,
               compile(std::span(&root, 1), options, plan, std::move(sources), &hashed));
  if (!program.plan.empty()) options.plans.take(std::move(program.plan));
  program.plan.clear();
  return program;
}

// The named files, but for those that another named file uses without being used by them: each
// begins a program of its own.
Result<std::vector<std::string>> program_roots(std::span<const std::string> files,
                                               const CompileOptions& options, SourceSet& sources) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    std::string name = std::filesystem::path(file).lexically_normal().string();
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  }
  std::map<std::string, std::set<std::string>> reached;  // by name
  for (const std::string& name : names) {
    Diagnostics again;  // what is wrong is said when the program is checked
    PROBE_ASSIGN(const syntax::Program program,
                 syntax::load_program(sources, name, options.library_folders, again));
    for (const syntax::ParseResult& result : program.files)
      reached[name].insert(sources.file(result.file.id).name());
  }
  // Files that use each other have no first one: all of them are checked.
  std::vector<std::string> roots;
  for (const std::string& name : names) {
    const bool is_below = std::any_of(names.begin(), names.end(), [&](const std::string& other) {
      return reached[other].contains(name) && !reached[name].contains(other);
    });
    if (!is_below) roots.push_back(name);
  }
  return roots;
}

void merge(Compilation&& program, Compilation& all) {
  all.sources = std::move(program.sources);
  for (const Diagnostic& said : program.diagnostics.items()) {
    const bool known = std::any_of(
        all.diagnostics.items().begin(), all.diagnostics.items().end(), [&](const Diagnostic& d) {
          return d.code == said.code && d.primary == said.primary && d.message == said.message;
        });
    if (!known) all.diagnostics.add(said);
  }
  all.ok = all.ok && program.ok;
  all.own_suites.insert(all.own_suites.end(), program.own_suites.begin(), program.own_suites.end());
  all.unused_phrases.insert(all.unused_phrases.end(), program.unused_phrases.begin(),
                            program.unused_phrases.end());
  all.referring.insert(all.referring.end(), program.referring.begin(), program.referring.end());
  all.chosen.insert(all.chosen.end(), program.chosen.begin(), program.chosen.end());
  all.called.merge(program.called);
  all.tasks += program.tasks;
  all.starts += program.starts;
}

}  // namespace

Result<Compilation> check(std::span<const std::string> files, const CompileOptions& options) {
  if (files.empty()) return compile(files, options, {}, with_unsaved(options));
  emit::AssetHashes hashed;
  if (files.size() < 2) return check_program(files.front(), options, with_unsaved(options), hashed);
  Compilation all;
  all.ok = true;
  all.sources = with_unsaved(options);
  PROBE_ASSIGN(const std::vector<std::string> roots, program_roots(files, options, all.sources));
  for (const std::string& root : roots) {
    PROBE_ASSIGN(Compilation program, check_program(root, options, std::move(all.sources), hashed));
    merge(std::move(program), all);
  }
  return all;
}

Result<Compilation> build(std::span<const std::string> files, const CompileOptions& options) {
  return compile(files, options, {true, true, 0}, with_unsaved(options));
}

Result<Counted> count(std::span<const std::string> files, const CompileOptions& options) {
  Analyzed analyzed;
  PROBE_TRY(analyze(files, options, analyzed));
  if (options.suite.empty()) {
    const Counts all{analyzed.compilation.tasks, analyzed.compilation.starts};
    return Counted{std::move(analyzed.compilation), all};
  }
  Counts counts;
  for (const sema::Suite& suite : analyzed.model.suites) {
    if (suite.name != options.suite) continue;
    for (const sema::TaskId id : suite.members) {
      const sema::Task& task = analyzed.model.tasks[id];
      if (task.abstract || !task.complete) continue;
      ++counts.tasks;
      counts.episodes += suite.starts_of(id, task).size();
    }
  }
  return Counted{std::move(analyzed.compilation), counts};
}

Result<AnalyzedText> analyze_text(std::span<const std::string> files,
                                  const CompileOptions& options) {
  Analyzed analyzed;
  PROBE_TRY(analyze(files, options, analyzed));
  std::set<std::uint32_t> roots;
  for (const FileId id : analyzed.ids) {
    const std::string& name = analyzed.compilation.sources.file(id).name();
    if (std::find(analyzed.roots.begin(), analyzed.roots.end(), name) != analyzed.roots.end())
      roots.insert(id.value);
  }
  return AnalyzedText{std::move(analyzed.compilation), std::move(analyzed.model),
                      std::move(roots)};
}

}  // namespace probe
