// The texts that an editor has open, as it last told of them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/language/positions.h"

namespace probe::lsp {

struct Document {
  std::string uri;  // as the editor spells it
  std::int64_t version = 0;
  std::string text;
};

// A range of the text as it was after the changes before it; without one, all of it.
struct Change {
  std::optional<language::Range> range;
  std::string text;
};

class Documents {
 public:
  // What is open already is replaced.
  void open(const std::string& path, Document document);
  // False where it is not open.
  bool change(const std::string& path, std::int64_t version, const std::vector<Change>& changes);
  bool close(const std::string& path);

  const Document* find(const std::string& path) const;
  const std::map<std::string, Document>& all() const { return all_; }  // by path
  std::map<std::string, std::string> texts() const;

 private:
  std::map<std::string, Document> all_;
};

}  // namespace probe::lsp
