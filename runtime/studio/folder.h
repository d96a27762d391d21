// The texts of the one folder that a studio was started for. Nothing outside it is read for the
// page, and nothing in it is written but texts and new tables of starts.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"

namespace probe::studio {

class Folder {
 public:
  static constexpr std::size_t kLargest = std::size_t{16} << 20;  // bytes of a text

  // Of a text that need not be there yet. Fails (kUsage) where its name does not end in ".probe"
  // or its folder is none.
  static Result<std::unique_ptr<Folder>> of(const std::string& file);

  const std::string& root() const { return root_; }  // absolute, without links
  const std::string& file() const { return file_; }  // the text to begin with, absolute
  // Every text in it, absolute, in the order of their names; at most 1,000.
  std::vector<std::string> texts() const;

  // Whether the page may have it: a text that lies in the folder when every link is followed.
  bool has(const std::string& path) const;

  struct Text {
    std::string text;
    bool is_new = false;  // there is no such file yet
  };
  // Fails (kUsage) on what the page may not have, (kIo) on what is no text or too large.
  Result<Text> open(const std::string& path);
  // Fails (kUsage) as open() does, and where the disk has something else than was opened or saved
  // last, unless `over` says that this is known.
  Status save(const std::string& path, const std::string& text, bool over);

  // Writes a table of starts beside the text, under the first name of TEXT_kept_1.csv, _2, ... that
  // nothing has. Returns the number.
  Result<int> keep_table(const std::string& table);
  // "my_kept_1.csv".
  std::string table_name(int number) const;

  // Texts that are otherwise on the disk than they were opened or saved.
  enum class News { kNone, kChanged, kGone };
  News news(const std::string& path);

 private:
  Folder(std::string root, std::string file) : root_(std::move(root)), file_(std::move(file)) {}
  Status check(const std::string& path) const;

  const std::string root_, file_;
  std::mutex mutex_;
  // What the disk had last, as far as the page knows; a hash of nothing: no file.
  std::map<std::string, Sha256> known_;
};

}  // namespace probe::studio
