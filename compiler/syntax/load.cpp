// Follows `use` from file to file. The only part of the syntax library that reads from disk.
#include <algorithm>
#include <filesystem>

#include "compiler/syntax/parser.h"

namespace probe::syntax {
namespace {

// What waits while a used file is being read: an explicit stack, for chains of `use` may be long.
struct Pending {
  ParseResult parsed;
  std::size_t next_decl = 0;
};

class Loader {
 public:
  Loader(SourceSet& sources, const std::vector<std::string>& folders, Diagnostics& diagnostics)
      : sources_(sources), folders_(folders), diagnostics_(diagnostics) {}

  Program run(FileId root) {
    open(root);
    while (!stack_.empty()) step();
    return std::move(program_);
  }

 private:
  void open(FileId id) {
    seen_.push_back(id);
    stack_.push_back({parse(sources_, id, diagnostics_), 0});
  }

  void step() {
    Pending& top = stack_.back();
    if (top.next_decl == top.parsed.file.decls.size()) {
      program_.ok = program_.ok && top.parsed.ok;
      program_.files.push_back(std::move(top.parsed));
      stack_.pop_back();
      return;
    }
    Decl& decl = top.parsed.file.decls[top.next_decl++];
    if (auto* layout = std::get_if<LayoutDecl>(&decl.node)) find_starts(*layout);
    if (auto* use = std::get_if<UseDecl>(&decl.node)) follow(*use);
  }

  // Tables of starts lie beside the text that names them.
  void find_starts(LayoutDecl& layout) {
    for (LayoutStmt& stmt : layout.body) {
      auto* starts = std::get_if<StartsStmt>(&stmt);
      if (starts == nullptr) continue;
      const std::filesystem::path text(sources_.file(starts->path.span.file).name());
      const std::string path =
          (text.parent_path() / starts->path.value).lexically_normal().string();
      if (starts->path.value.empty()) {
        diagnostics_.report(Situation::kStartsMissing, starts->path.span,
                            "the name of a file of starts is empty");
        continue;
      }
      const Result<FileId> loaded = sources_.load(path);
      if (loaded.ok()) {
        starts->file = *loaded;
      } else {
        diagnostics_
            .report(Situation::kStartsMissing, starts->path.span,
                    "cannot read the starts of `" + starts->path.value + "`")
            .point(loaded.failure().message)
            .help("looked for `" + path + "`");
      }
    }
  }

  // The stack may move under `use` when a file is opened: nothing is done with it after that.
  void follow(UseDecl& use) {
    const std::filesystem::path wanted(use.path.value);
    std::vector<std::string> tried;
    if (!wanted.empty()) {
      const std::filesystem::path beside =
          std::filesystem::path(sources_.file(use.path.span.file).name()).parent_path();
      tried.push_back((beside / wanted).lexically_normal().string());
      for (const std::string& folder : folders_) {
        tried.push_back((std::filesystem::path(folder) / wanted).lexically_normal().string());
      }
    }
    std::string reason = "the name is empty";
    for (const std::string& path : tried) {
      const Result<FileId> loaded = sources_.load(path);
      if (loaded.ok()) {
        use.file = *loaded;
        // A file that is being read or was read is not read again: circles of `use` are harmless.
        const bool known = std::find(seen_.begin(), seen_.end(), *loaded) != seen_.end();
        if (!known) open(*loaded);
        return;
      }
      if (path == tried.front()) reason = loaded.failure().message;
    }
    program_.ok = false;
    Diagnostic& error = diagnostics_.report(Situation::kUseMissing, use.path.span,
                                            "cannot use `" + use.path.value + "`");
    error.point(reason).note("the names that it declares are unknown; they are not listed");
    if (!tried.empty()) {
      std::string places = "looked for";
      for (const std::string& path : tried)
        places += (path == tried.front() ? " `" : ", `") + path + "`";
      error.help(places);
    }
  }

  SourceSet& sources_;
  const std::vector<std::string>& folders_;
  Diagnostics& diagnostics_;
  std::vector<FileId> seen_;
  std::vector<Pending> stack_;
  Program program_;
};

}  // namespace

Result<Program> load_program(SourceSet& sources, const std::string& root,
                             const std::vector<std::string>& library_folders,
                             Diagnostics& diagnostics) {
  const std::string name = std::filesystem::path(root).lexically_normal().string();
  PROBE_ASSIGN(const FileId id, sources.load(name));
  return Loader(sources, library_folders, diagnostics).run(id);
}

}  // namespace probe::syntax
