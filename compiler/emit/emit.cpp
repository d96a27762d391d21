#include "compiler/emit/emit.h"

#include <filesystem>

#include "compiler/emit/emitter.h"

namespace probe::emit {

Result<std::vector<std::byte>> Emitter::run(const std::vector<FileId>& files) {
  if (options_.write) add_sources(files);
  const std::vector<TaskId> chosen = choose_tasks();
  for (std::size_t i = 0; i < chosen.size(); ++i)
    tasks_.add(chosen[i], static_cast<std::uint32_t>(i));
  for (const TaskId id : chosen) add_task(model_.tasks[id]);
  add_questions();
  report_constants();
  report_misses(chosen);
  if (diagnostics_.has_errors()) return std::vector<std::byte>{};
  add_assets();
  add_sets();
  add_suites();
  if (!check_language_only(chosen) || !options_.write) return std::vector<std::byte>{};
  return writer_.finish({.identity = options_.proves});
}

std::vector<TaskId> Emitter::choose_tasks() const {
  std::vector<bool> wanted(model_.tasks.size(), options_.suite.empty());
  for (const sema::Suite& suite : model_.suites) {
    if (options_.suite.empty() || suite.name != options_.suite) continue;
    for (const TaskId id : suite.members) {
      wanted[static_cast<std::size_t>(id)] = true;
      const TaskId baseline = model_.tasks[id].baseline;
      if (baseline != TaskId::kNone) wanted[static_cast<std::size_t>(baseline)] = true;
    }
  }
  std::vector<TaskId> chosen;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const sema::Task& task = model_.tasks[static_cast<TaskId>(i)];
    const bool is_kept = !options_.wants_task || options_.wants_task(task.name);
    if (wanted[i] && is_kept && !task.abstract && task.complete) {
      chosen.push_back(static_cast<TaskId>(i));
    }
  }
  return chosen;
}

void Emitter::add_sources(const std::vector<FileId>& files) {
  for (const FileId id : files) {
    const SourceFile& file = sources_.file(id);
    const std::filesystem::path name(file.name());
    const std::string path =
        name.lexically_normal().lexically_relative(options_.source_folder).generic_string();
    texts_[id.value] = writer_.source(path.empty() ? name.filename().string() : path, file.text());
  }
}

void Emitter::add_span(plan::SpanKind what, std::uint32_t index, const Span& span) {
  const auto text = texts_.find(span.file.value);
  if (text != texts_.end())
    records().spans.push_back(
        {static_cast<std::uint32_t>(what), index, text->second, span.begin, span.end});
}

Result<std::vector<std::byte>> emit(const Model& model, const SourceSet& sources,
                                    const std::vector<FileId>& files, const EmitOptions& options,
                                    Diagnostics& diagnostics) {
  return Emitter(model, sources, options, diagnostics).run(files);
}

}  // namespace probe::emit
