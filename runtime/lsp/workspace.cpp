#include "runtime/lsp/workspace.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <tuple>

#include "runtime/compile/files.h"
#include "runtime/lsp/common_ends.h"

namespace probe::lsp {
namespace {

namespace fs = std::filesystem;
using language::Snapshot;

// What makes two of them the same.
auto key_of(const Diagnostic& item) {
  const Span& at = item.primary;
  return std::tuple(item.code, at.file.value, at.begin, at.end, std::string_view(item.message));
}

bool is_in(const Snapshot& snapshot, const std::string& path) {
  return snapshot.find(path).has_value();
}

// A `use` or a table that was not found may be there now.
bool is_of_files(const Diagnostic& item) {
  return item.code == Code::P0202 || item.code == Code::P1501;
}
bool misses_files(const Snapshot& snapshot) {
  return std::ranges::any_of(snapshot.diagnostics().items(), is_of_files);
}

// Files of one program as files of another, by their paths.
class Files {
 public:
  Files(const std::vector<std::string>& paths, const Snapshot& to) {
    for (const std::string& path : paths) ids_.push_back(to.sources().find(path).value_or(FileId{}));
  }
  bool move(Span& span) const {
    if (span.is_none()) return true;
    span.file = span.file.value < ids_.size() ? ids_[span.file.value] : FileId{};
    return !span.is_none();
  }
  // False where it speaks of a file that is not there.
  bool move(Diagnostic& item) const {
    bool moved = move(item.primary);
    for (Label& label : item.labels) moved = move(label.span) && moved;
    if (item.fix) {
      for (Replacement& part : item.fix->replacements) moved = move(part.span) && moved;
    }
    return moved;
  }

 private:
  std::vector<FileId> ids_;
};

std::vector<std::string> paths_of(const SourceSet& sources) {
  std::vector<std::string> paths;
  for (std::uint32_t i = 0; i < sources.size(); ++i)
    paths.push_back(sources.file(FileId{i}).name());
  return paths;
}

// Spans of a text in what it has become.
struct Moved {
  std::size_t before = 0, after = 0;  // bytes
  CommonEnds kept;
  Moved(std::string_view a, std::string_view b)
      : before(a.size()), after(b.size()), kept(common_ends(a, b)) {}
  // False where it differs.
  bool move(Span& span) const {
    if (span.end <= kept.front) return true;
    if (span.begin < before - kept.back) return false;
    span.begin = static_cast<std::uint32_t>(span.begin + after - before);
    span.end = static_cast<std::uint32_t>(span.end + after - before);
    return true;
  }
};

}  // namespace

std::vector<const Diagnostic*> Program::said(FileId file) const {
  std::vector<const Diagnostic*> out;
  const auto add = [&](const Diagnostic& item) {
    // What is about no place is about the root.
    const FileId at = item.primary.is_none() ? now->root() : item.primary.file;
    if (at == file) out.push_back(&item);
  };
  for (const Diagnostic& item : now->diagnostics().items()) add(item);
  for (const Diagnostic& item : slow) add(item);
  return out;
}

std::optional<WholeCheck> check_whole(const std::string& root, const language::Unsaved& unsaved,
                                      const AssetRoot& assets, const std::string& library,
                                      const std::atomic<bool>& stop) {
  auto checked = compile::compile_files({root}, {.assets = assets,
                                                 .library = library,
                                                 .wants_plan = false,
                                                 .unsaved = unsaved,
                                                 .stop = &stop});
  if (!checked || stop) return std::nullopt;
  return WholeCheck{checked->diagnostics.items(), paths_of(checked->sources)};
}

void Workspace::take(Program& program, const WholeCheck& checked) {
  program.slow.clear();
  program.is_checked = true;
  const Files files(checked.paths, *program.now);
  std::set<decltype(key_of(Diagnostic()))> known;
  for (const Diagnostic& item : program.now->diagnostics().items()) known.insert(key_of(item));
  for (Diagnostic item : checked.items) {
    if (files.move(item) && !known.contains(key_of(item)))
      program.slow.push_back(std::move(item));
  }
}

// What the whole check said before stays in sight, moved with the text that it is about, until it
// has been asked again.
void Workspace::carry_over(const Program& before, Program& after) const {
  const Snapshot& old = *before.now;
  const Snapshot& now = *after.now;
  const Files files(paths_of(old.sources()), now);
  std::map<FileId, Moved> moved;
  for (Diagnostic item : before.slow) {
    // Of files that lack nothing older than now is believed.
    if (item.primary.is_none() || is_of_files(item)) continue;
    const FileId was = item.primary.file;
    item.labels.clear();
    item.fix.reset();
    if (!files.move(item)) continue;
    const auto [at, is_new] =
        moved.try_emplace(was, old.text(was), now.text(item.primary.file));
    if (at->second.move(item.primary)) after.slow.push_back(std::move(item));
  }
}

void Workspace::touch(const std::string& path) {
  if (path.empty()) is_all_touched_ = true;
  touched_.insert(path);
  has_others_ = false;
}

bool Workspace::refresh() {
  if (touched_.empty()) return false;
  const language::Unsaved unsaved = documents.texts();
  std::vector<std::unique_ptr<Program>> before = std::move(programs_);
  programs_.clear();
  bool is_new = false;
  const auto is_reached = [&](const std::string& path) {
    return std::ranges::any_of(
        programs_, [&](const auto& program) { return is_in(*program->now, path); });
  };
  // Programs that there were come first: they know whom they reach.
  std::vector<std::string> roots;
  for (const auto& program : before) {
    if (unsaved.contains(program->root)) roots.push_back(program->root);
  }
  for (const auto& [path, text] : unsaved) {
    if (std::ranges::find(roots, path) == roots.end()) roots.push_back(path);
  }
  for (const std::string& root : roots) {
    if (is_reached(root)) continue;
    const auto old = std::ranges::find(before, root, [](const auto& program) {
      return program == nullptr ? std::string() : program->root;
    });
    const bool is_stale = old == before.end() || is_all_touched_ || misses_files(*(*old)->now) ||
                          std::ranges::any_of(touched_, [&](const std::string& path) {
                            return (*old)->now->reads(path);
                          });
    std::unique_ptr<Program> program;
    if (!is_stale) {
      program = std::move(*old);
    } else {
      program = std::make_unique<Program>();
      program->root = root;
      program->remembered = old != before.end() && (*old)->remembered != nullptr
                                ? std::move((*old)->remembered)
                                : std::make_unique<sema::Remembered>();
      program->now = Snapshot::analysed(root, unsaved, setting_, program->remembered.get());
      if (program->now == nullptr) continue;
      if (old != before.end()) carry_over(**old, *program);
      is_new = true;
    }
    std::erase_if(programs_, [&](const auto& known) {
      return is_in(*program->now, known->root) && !is_in(*known->now, program->root);
    });
    programs_.push_back(std::move(program));
  }
  is_new = is_new || programs_.size() != before.size();
  for (auto& program : before) {
    if (program != nullptr) old_.push_back(std::move(program));
  }
  touched_.clear();
  is_all_touched_ = false;
  return is_new;
}

std::shared_ptr<void> Workspace::take_old() {
  auto old = std::make_shared<std::vector<std::unique_ptr<Program>>>(std::move(old_));
  old_.clear();
  return old->empty() ? nullptr : old;
}

Workspace::Found Workspace::find(const std::string& path) {
  if (documents.find(path) == nullptr) return {};
  refresh();
  for (const auto& program : programs_) {
    if (const auto file = program->now->find(path)) return {program.get(), *file};
  }
  return {};
}

bool Workspace::is_ours(const std::string& path) const {
  if (documents.find(path) != nullptr) return true;
  return std::ranges::any_of(folders, [&](const std::string& folder) {
    const std::string prefix = folder.ends_with('/') ? folder : folder + "/";
    return path.starts_with(prefix);
  });
}

std::vector<std::string> Workspace::texts_in_folders() {
  constexpr std::size_t kMost = 1000;         // texts
  constexpr std::size_t kMostLooked = 50000;  // entries
  constexpr int kDeepest = 12;
  std::vector<std::string> out;
  std::size_t looked = 0;
  missed_.clear();
  struct Todo {
    fs::path folder;
    int depth = 0;
  };
  // What is hidden comes last: it may be large, and is seldom meant.
  std::deque<Todo> todo;
  for (const std::string& folder : folders) todo.push_front({folder, 0});
  while (!todo.empty()) {
    const Todo now = std::move(todo.front());
    todo.pop_front();
    std::error_code error;
    fs::directory_iterator at(now.folder, error);
    for (const fs::directory_iterator end; !error && at != end; at.increment(error)) {
      const bool is_full = ++looked > kMostLooked;
      if (is_full || out.size() > kMost) {
        missed_ = is_full ? "it has more than " + std::to_string(kMostLooked) + " entries"
                          : "it has more than " + std::to_string(kMost) + " texts";
        todo.clear();
        break;
      }
      const std::string name = at->path().filename().string();
      std::error_code ignored;  // what is gone meanwhile is neither
      if (at->is_directory(ignored)) {
        const bool is_skipped = at->is_symlink(ignored) || name == "node_modules" ||
                                name == ".git" || name == ".hg" || name == ".svn";
        if (is_skipped) continue;
        if (now.depth >= kDeepest) {
          missed_ = at->path().string() + " lies too deep";
        } else if (name.starts_with('.')) {
          todo.push_back({at->path(), now.depth + 1});
        } else {
          todo.push_front({at->path(), now.depth + 1});
        }
        continue;
      }
      if (name.ends_with(".probe") && at->is_regular_file(ignored))
        out.push_back(at->path().lexically_normal().string());
    }
    if (error) missed_ = now.folder.string() + " cannot be read";
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<const Snapshot*> Workspace::others() {
  refresh();
  if (!has_others_) {
    others_.clear();
    const language::Unsaved unsaved = documents.texts();
    for (const std::string& path : texts_in_folders()) {
      const auto reaches = [&](const auto& snapshot) { return is_in(*snapshot, path); };
      const bool is_known =
          std::ranges::any_of(programs_,
                              [&](const auto& program) { return reaches(program->now); }) ||
          std::ranges::any_of(others_, reaches);
      if (is_known) continue;
      auto other = Snapshot::parsed(path, unsaved, setting_);
      if (other == nullptr) {
        missed_ = path + " cannot be read";
        continue;
      }
      std::erase_if(others_, [&](const auto& known) {
        return is_in(*other, known->path(known->root()));
      });
      others_.push_back(std::move(other));
    }
    has_others_ = true;
  }
  std::vector<const Snapshot*> out;
  for (const auto& program : programs_) out.push_back(program->now.get());
  for (const auto& other : others_) out.push_back(other.get());
  return out;
}

}  // namespace probe::lsp
