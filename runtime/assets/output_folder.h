// An asset folder while it is being made: whole under its name, or absent.
#pragma once

#include <string>
#include <string_view>

#include "runtime/assets/manifest.h"
#include "runtime/base/result.h"

namespace probe::assets {

class OutputFolder {
 public:
  // Fails (kIo) when `path` is there and not an empty folder. Removes what processes of this
  // machine left beside it that were killed while they made the same folder.
  static Result<OutputFolder> create(const std::string& path);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();  // removes what was not finished

  // `source` is what the file was made from, for the manifest.
  Status write(const std::string& path, std::string_view bytes, const std::string& source);
  // Where the files are until then.
  const std::string& path() const { return temporary_; }
  bool has(std::string_view path) const { return manifest_.find(path) != nullptr; }
  std::uint64_t bytes() const;

  // Gives the folder its name; `with_manifest` writes manifest.json first.
  Status finish(bool with_manifest = true);

 private:
  OutputFolder(std::string target, std::string temporary)
      : target_(std::move(target)), temporary_(std::move(temporary)) {}
  std::string target_, temporary_;
  Manifest manifest_;
};

}  // namespace probe::assets
