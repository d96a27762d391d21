// Chunks of binary glTF, tables of glTF, arrays of Collada.
#include "runtime/scene/mesh_counts.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/large.h"
#include "runtime/scene/mesh_references.h"

namespace probe::scene {
namespace {

Failure no_mesh(const std::string& what) { return {Fault::kAsset, what, ""}; }

// ---- glTF

// A table's field: absent, or a whole number of at most kMaxMeshBytes.
Status check_field(const Json& entry, const char* table, std::size_t index, const char* field) {
  const Json* found = entry.find(field);
  if (found == nullptr) return {};
  if (found->is_number_unsigned() && found->get<std::uint64_t>() <= allowed(kMaxMeshBytes))
    return {};
  return no_mesh(std::string("`") + field + "` of `" + table + "` " + std::to_string(index) +
                 " is " + found->dump() + ", not a number that such a file can have");
}

Status check_gltf(std::string_view text) {
  const Json root = Json::parse(text);
  if (!root.is_object()) return no_mesh("the glTF description is no JSON object");
  struct Table {
    const char* name;
    std::vector<const char*> fields;
  };
  const Table tables[] = {{"buffers", {"byteLength"}},
                          {"bufferViews", {"byteLength", "byteOffset", "byteStride"}},
                          {"accessors", {"count", "byteOffset"}}};
  for (const Table& table : tables) {
    const Json* list = root.find(table.name);
    if (list == nullptr) continue;
    if (!list->is_array()) return no_mesh(std::string("`") + table.name + "` is no list");
    std::size_t index = 0;
    for (const Json& entry : *list) {
      if (!entry.is_object())
        return no_mesh(std::string("`") + table.name + "` " + std::to_string(index) +
                       " is no object");
      for (const char* field : table.fields)
        PROBE_TRY(check_field(entry, table.name, index, field));
      ++index;
    }
  }
  return {};
}

// Chunks lie inside the file, the description first.
Status check_glb(std::string_view file) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, 4);
    return std::size_t{value};
  };
  if (file.size() < 20 || file.substr(0, 4) != "glTF" || file.substr(16, 4) != "JSON") {
    return no_mesh("is no binary glTF: its first 20 bytes are not those of one");
  }
  std::string_view description;
  for (std::size_t at = 12; at + 8 <= file.size();) {
    const std::size_t length = number(at);
    if (length > file.size() - at - 8) {
      return no_mesh("a chunk of " + std::to_string(length) + " bytes at byte " +
                     std::to_string(at) + " ends beyond the file: it is cut off or damaged");
    }
    if (description.empty()) description = file.substr(at + 8, length);
    at += 8 + length;
  }
  return check_gltf(description);
}

// ---- Collada

struct Tag {
  std::string_view name;  // "/p" where it closes
  std::string_view attributes;
  std::string_view text;  // up to the next tag
};

std::optional<std::string_view> attribute(const Tag& tag, std::string_view name) {
  const std::string_view all = tag.attributes;
  for (std::size_t at = all.find(name); at != all.npos; at = all.find(name, at + 1)) {
    const bool begins = at > 0 && (all[at - 1] == ' ' || all[at - 1] == '\n' ||
                                   all[at - 1] == '\t' || all[at - 1] == '\r');
    std::size_t quote = all.find_first_not_of(" \t\r\n", at + name.size());
    if (!begins || quote == all.npos || all[quote] != '=') continue;
    quote = all.find_first_not_of(" \t\r\n", quote + 1);
    if (quote == all.npos || (all[quote] != '"' && all[quote] != '\'')) continue;
    const std::size_t end = all.find(all[quote], quote + 1);
    if (end == all.npos) return std::nullopt;
    return all.substr(quote + 1, end - quote - 1);
  }
  return std::nullopt;
}

// A whole number in text, at most kMaxMeshBytes; the importer takes what is none for 0.
std::optional<std::size_t> whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
      value > allowed(kMaxMeshBytes))
    return std::nullopt;
  return value;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::size_t count_words(std::string_view text) {
  std::size_t words = 0;
  bool inside = false;
  for (const char c : text) {
    words += !inside && !is_blank(c);
    inside = !is_blank(c);
  }
  return words;
}

class Collada {
 public:
  Status check(std::string_view text) {
    for (std::size_t at = text.find('<'); at != text.npos;) {
      if (const std::size_t end = skipped(text, at); end != at) {
        at = text.find('<', end);
        continue;
      }
      const std::size_t close = text.find('>', at);
      if (close == text.npos) return no_mesh("the last tag does not end: the file is cut off");
      const std::size_t next = std::min(text.find('<', close), text.size());
      Tag tag;
      const std::string_view inner = text.substr(at + 1, close - at - 1);
      const std::size_t name_end = std::min(inner.find_first_of(" \t\r\n/", 1), inner.size());
      tag.name = inner.substr(0, name_end);
      tag.attributes = inner.substr(name_end);
      tag.text = text.substr(close + 1, next - close - 1);
      PROBE_TRY(read(tag));
      at = next == text.size() ? text.npos : next;
    }
    return check_accessors();
  }

 private:
  // Behind a comment, an instruction or a declaration that begins at `at`; else `at`.
  static std::size_t skipped(std::string_view text, std::size_t at) {
    const auto behind = [&](std::string_view open, std::string_view close) {
      if (text.substr(at, open.size()) != open) return at;
      const std::size_t end = text.find(close, at + open.size());
      return end == text.npos ? text.size() : end + close.size();
    };
    for (const auto& [open, close] : {std::pair("<!--", "-->"), std::pair("<![CDATA[", "]]>"),
                                      std::pair("<?", "?>"), std::pair("<!", ">")}) {
      if (const std::size_t end = behind(open, close); end != at) return end;
    }
    return at;
  }

  static Failure stated(const Tag& tag, std::string_view name) {
    return no_mesh("`" + std::string(name) + "` of <" + std::string(tag.name) + "> is `" +
                   std::string(attribute(tag, name).value_or("")) +
                   "`, not a number that such a file can have");
  }
  // Absent is `otherwise`.
  static Result<std::size_t> number(const Tag& tag, std::string_view name, std::size_t otherwise) {
    const auto text = attribute(tag, name);
    if (!text) return otherwise;
    const auto value = whole(*text);
    if (!value) return stated(tag, name);
    return *value;
  }

  Status read(const Tag& tag) {
    static constexpr std::string_view kArrays[] = {"float_array", "int_array", "Name_array",
                                                   "bool_array", "IDREF_array"};
    static constexpr std::string_view kPrimitives[] = {
        "triangles", "polylist", "polygons", "trifans", "tristrips", "lines", "linestrips"};
    static constexpr std::string_view kIndices[] = {"p", "h", "vcount", "v"};
    const auto is_one = [&](const auto& names) {
      return std::find(std::begin(names), std::end(names), tag.name) != std::end(names);
    };
    if (is_one(kArrays)) return array(tag);
    if (tag.name == "accessor") return accessor(tag);
    if (tag.name == "param" && !accessors_.empty() && in_accessor_) ++accessors_.back().params;
    if (tag.name == "/accessor") in_accessor_ = false;
    if (is_one(kPrimitives)) return number(tag, "count", 0).ok() ? Status() : stated(tag, "count");
    if (tag.name == "input") {
      for (const char* name : {"offset", "set"}) PROBE_TRY(number(tag, name, 0));
    }
    if (is_one(kIndices)) return indices(tag);
    return {};
  }

  Status array(const Tag& tag) {
    PROBE_ASSIGN(const std::size_t count, number(tag, "count", 0));
    const std::size_t words = count_words(tag.text);
    if (words < count) {
      return no_mesh("<" + std::string(tag.name) + "> says it has " + std::to_string(count) +
                     " values and has " + std::to_string(words));
    }
    const auto [known, is_new] = arrays_.try_emplace(attribute(tag, "id").value_or(""), count);
    if (!is_new) known->second = std::min(known->second, count);
    return {};
  }

  Status accessor(const Tag& tag) {
    Accessor read;
    read.source = attribute(tag, "source").value_or("");
    if (read.source.starts_with("#")) read.source.remove_prefix(1);
    PROBE_ASSIGN(read.count, number(tag, "count", 0));
    PROBE_ASSIGN(read.offset, number(tag, "offset", 0));
    PROBE_ASSIGN(read.stride, number(tag, "stride", 1));
    in_accessor_ = !tag.attributes.ends_with("/");
    accessors_.push_back(read);
    return {};
  }

  // What is none ends no list for the importer.
  static Status indices(const Tag& tag) {
    for (const char c : tag.text) {
      if (is_blank(c) || c == '-' || (c >= '0' && c <= '9')) continue;
      return no_mesh("<" + std::string(tag.name) + "> lists whole numbers and has `" +
                     std::string(1, c) + "`");
    }
    return {};
  }

  Status check_accessors() const {
    for (const Accessor& a : accessors_) {
      const auto array = arrays_.find(a.source);
      if (array == arrays_.end() || a.count == 0) continue;
      const std::size_t last =
          a.offset + (a.count - 1) * a.stride + std::max<std::size_t>(1, a.params);
      if (last <= array->second) continue;
      return no_mesh("an accessor takes " + std::to_string(last) + " values of `" +
                     std::string(a.source) + "`, which has " + std::to_string(array->second));
    }
    return {};
  }

  struct Accessor {
    std::string_view source;
    std::size_t count = 0, offset = 0, stride = 1, params = 0;
  };
  std::map<std::string_view, std::size_t> arrays_;  // values, by id
  std::vector<Accessor> accessors_;
  bool in_accessor_ = false;
};

}  // namespace

Status check_counts(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".glb" && extension != ".gltf" && extension != ".dae") return {};
  PROBE_ASSIGN(const std::string file, read_file(path));
  Status checked = extension == ".glb"    ? check_glb(file)
                   : extension == ".gltf" ? check_gltf(file)
                                          : Collada().check(file);
  if (checked) return {};
  Failure failure = checked.failure();
  failure.where = path;
  return failure;
}

}  // namespace probe::scene
