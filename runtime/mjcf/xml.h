// An XML text as a tree that remembers where everything stood, with `include` elements replaced by
// what they name. Knows nothing of bodies. xml.cpp is the only file of this folder that includes
// TinyXML.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"

namespace probe::mjcf {

// Where something is written.
struct At {
  std::uint32_t file = 0;  // index of the files that were read
  int line = 0;            // from 1
};

struct Element {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;  // in order, names differ
  std::vector<Element> children;
  At at;

  // Null where it is not said.
  const std::string* find(std::string_view attribute) const;
};

struct Document {
  Element root;                    // `mujoco`
  std::vector<std::string> files;  // paths; the first is the one asked for

  std::string where(const At& at) const;  // "cabinet.xml:12", with the path as it was given
};

// Files that are included are found beside the first one, as MuJoCo does; theirs is the content of
// their root. Fails (kAsset, where = path or path:line) on a missing file, text that is not XML,
// another root than `mujoco`, a file that is included twice or within itself, more than 64 MB or
// 100,000 elements, elements nested deeper than 500, one of more than 100 attributes.
Result<Document> read_document(const std::string& path);

}  // namespace probe::mjcf
