// TinyXML's tree, copied: it is gone when the function returns.
#include "runtime/mjcf/xml.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/base/xml_size.h"

namespace probe::mjcf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestText = std::size_t{64} << 20;

class Reader {
 public:
  explicit Reader(const std::string& path) : folder_(fs::path(path).parent_path()) {}

  Result<Document> read(const std::string& path) {
    PROBE_ASSIGN(document_.root, read_root(path, {}));
    if (document_.root.tag != "mujoco") {
      return Failure{Fault::kAsset,
                     fmt::format("the outermost element is `{}`, not `mujoco`", document_.root.tag),
                     document_.where(document_.root.at)};
    }
    return std::move(document_);
  }

 private:
  // The root element of a file; `from` is where it is included, with line 0 where it is not.
  Result<Element> read_root(const std::string& path, const At& from) {
    const std::string by = from.line == 0 ? path : document_.where(from);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
      return Failure{Fault::kAsset,
                     from.line == 0 ? "no such file" : "includes `" + path + "`, which is no file",
                     by};
    }
    for (const std::string& known : document_.files) {
      if (!fs::equivalent(known, path, error)) continue;
      return Failure{Fault::kAsset, "includes `" + path + "`, which is read already", by};
    }
    PROBE_ASSIGN(
        const std::string text,
        read_file(path, {.most = kLongestText, .code = Fault::kAsset, .only_begin = false}));
    const auto file = static_cast<std::uint32_t>(document_.files.size());
    document_.files.push_back(path);
    PROBE_TRY(check_size(text, path));
    TiXmlDocument parsed;
    parsed.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
    if (parsed.Error()) {
      return Failure{Fault::kAsset, fmt::format("not XML: {}", parsed.ErrorDesc()),
                     document_.where({file, parsed.ErrorRow()})};
    }
    const TiXmlElement* root = parsed.RootElement();
    if (root == nullptr) return Failure{Fault::kAsset, "not XML: no element in it", path};
    return copy(*root, file);
  }

  Status check_size(const std::string& text, const std::string& path) {
    // TinyXML reads a C string and would not see what follows.
    if (text.find('\0') != text.npos)
      return Failure{Fault::kAsset, "not XML: a zero byte in it", path};
    return check_xml_size(text, Fault::kAsset, path, &elements_);
  }

  Result<Element> copy(const TiXmlElement& from, std::uint32_t file) {
    Element made;
    made.tag = from.ValueStr();
    made.at = {file, from.Row()};
    for (const TiXmlAttribute* a = from.FirstAttribute(); a != nullptr; a = a->Next())
      made.attributes.emplace_back(a->Name(), a->ValueStr());
    for (const TiXmlElement* e = from.FirstChildElement(); e; e = e->NextSiblingElement()) {
      PROBE_ASSIGN(Element child, copy(*e, file));
      if (child.tag != "include") {
        made.children.push_back(std::move(child));
        continue;
      }
      const std::string* name = child.find("file");
      if (name == nullptr || name->empty())
        return Failure{Fault::kAsset, "`include` without `file`", document_.where(child.at)};
      PROBE_ASSIGN(Element included, read_root((folder_ / *name).string(), child.at));
      std::ranges::move(included.children, std::back_inserter(made.children));
    }
    return made;
  }

  fs::path folder_;
  Document document_;
  std::size_t elements_ = 0;
};

}  // namespace

const std::string* Element::find(std::string_view attribute) const {
  for (const auto& [name, value] : attributes) {
    if (name == attribute) return &value;
  }
  return nullptr;
}

std::string Document::where(const At& at) const {
  return fmt::format("{}:{}", files[at.file], at.line);
}

Result<Document> read_document(const std::string& path) { return Reader(path).read(path); }

}  // namespace probe::mjcf
