#include "compiler/language/snapshot.h"

#include <algorithm>
#include <filesystem>

namespace probe::language {

std::unique_ptr<Snapshot> Snapshot::read(const std::string& root, const Unsaved& unsaved,
                                         const Setting& setting) {
  std::unique_ptr<Snapshot> out(new Snapshot);
  for (const auto& [path, text] : unsaved) out->sources_.add(path, text);
  auto program =
      syntax::load_program(out->sources_, root, setting.library_folders, out->diagnostics_);
  if (!program) return nullptr;
  out->program_ = std::move(*program);
  out->root_ = out->program_.files.back().file.id;
  return out;
}

std::unique_ptr<Snapshot> Snapshot::analysed(const std::string& root, const Unsaved& unsaved,
                                             const Setting& setting,
                                             sema::Remembered* remembered) {
  auto out = read(root, unsaved, setting);
  if (out == nullptr) return nullptr;
  std::vector<const syntax::File*> trees;
  for (const syntax::ParseResult& file : out->program_.files) trees.push_back(&file.file);
  std::vector<std::string> texts;  // as the compiler has them
  texts.push_back(out->path(out->root_));
  for (const syntax::ParseResult& file : out->program_.files) texts.push_back(out->path(file.file.id));
  out->model_ = sema::analyze(out->sources_, trees, setting.asset_root.beside(texts), out->diagnostics_,
                              {out->root_}, {.is_immediate = true, .wants = &out->wants_, .remembered = remembered});
  return out;
}

std::unique_ptr<Snapshot> Snapshot::parsed(const std::string& root, const Unsaved& unsaved,
                                           const Setting& setting) {
  return read(root, unsaved, setting);
}

std::optional<FileId> Snapshot::find(std::string_view path) const {
  for (const syntax::ParseResult& file : program_.files) {
    if (sources_.file(file.file.id).name() == path) return file.file.id;
  }
  return std::nullopt;
}

bool Snapshot::reads(std::string_view path) const {
  if (find(path)) return true;
  const std::optional<FileId> table = sources_.find(path);
  if (!table) return false;
  const auto is_read = [&](const syntax::LayoutStmt& stmt) {
    const auto* starts = std::get_if<syntax::StartsStmt>(&stmt);
    return starts != nullptr && starts->file == *table;
  };
  for (const syntax::ParseResult& file : program_.files) {
    for (const syntax::Decl& decl : file.file.decls) {
      const auto* layout = std::get_if<syntax::LayoutDecl>(&decl.node);
      if (layout != nullptr && std::ranges::any_of(layout->body, is_read)) return true;
    }
  }
  return false;
}

const syntax::ParseResult* Snapshot::tree(FileId id) const {
  for (const syntax::ParseResult& file : program_.files) {
    if (file.file.id == id) return &file;
  }
  return nullptr;
}

const Index& Snapshot::index() const {
  if (index_ == nullptr) index_ = std::make_unique<Index>(program_.files);
  return *index_;
}

const Lines& Snapshot::lines(FileId file) const {
  std::unique_ptr<Lines>& known = lines_[file];
  if (known == nullptr) known = std::make_unique<Lines>(text(file));
  return *known;
}

const sema::Task* Snapshot::task(std::string_view name) const {
  const auto found = std::ranges::find(model_.tasks, name, &sema::Task::name);
  return found == model_.tasks.end() ? nullptr : &*found;
}

const syntax::Decl* Snapshot::decl_at(FileId file, std::uint32_t offset) const {
  const syntax::ParseResult* parsed = tree(file);
  if (parsed == nullptr) return nullptr;
  for (const syntax::Decl& decl : parsed->file.decls) {
    if (decl.span.begin <= offset && offset <= decl.span.end) return &decl;
  }
  return nullptr;
}

}  // namespace probe::language
