// The arrows between folders, as built and as written: what a folder links in its CMakeLists.txt
// and what its files include.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
const fs::path kRoot = VLAPROBE_SOURCE_DIR;

using Names = std::set<std::string>;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Folder {
  std::string path;                             // "runtime/wire"
  Names links;                                  // libraries of ours
  std::map<std::string, std::string> includes;  // by library: a file and its line
};

// By the name of its library.
std::map<std::string, Folder> all_folders() {
  static const std::regex kLibrary(R"(probe_library\(([^)]*)\))"), kComment("#[^\n]*");
  std::map<std::string, Folder> folders;
  for (const char* top : {"compiler", "runtime"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      if (entry.path().filename() != "CMakeLists.txt") continue;
      const std::string text = std::regex_replace(text_of(entry.path()), kComment, "");
      std::smatch found;
      if (!std::regex_search(text, found, kLibrary)) continue;
      std::istringstream words(found[1].str());
      std::string name, word;
      words >> name;
      Folder& folder = folders[name];
      folder.path = fs::relative(entry.path().parent_path(), kRoot).generic_string();
      while (words >> word) {
        if (word.starts_with("probe_")) folder.links.insert(word);
      }
    }
  }
  return folders;
}

// The library of the nearest folder above that has one; empty when there is none.
std::string library_of(const std::map<std::string, std::string>& by_path, fs::path path) {
  while (path.has_parent_path() && path != path.parent_path()) {
    path = path.parent_path();
    const auto found = by_path.find(path.generic_string());
    if (found != by_path.end()) return found->second;
  }
  return {};
}

void read_includes(std::map<std::string, Folder>& folders) {
  static const std::regex kInclude(R"(#include "((compiler|runtime)/[^"]+)\")");
  std::map<std::string, std::string> by_path;
  for (const auto& [name, folder] : folders) by_path.emplace(folder.path, name);
  for (const char* top : {"compiler", "runtime"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      const std::string file = fs::relative(entry.path(), kRoot).generic_string();
      // Programs link what they need beside the library of their folder.
      if (file.find("/main/") != std::string::npos || file.find("/libm/") != std::string::npos)
        continue;
      const std::string own = library_of(by_path, file);
      if (own.empty()) continue;
      const std::string text = text_of(entry.path());
      for (std::sregex_iterator at(text.begin(), text.end(), kInclude), end; at != end; ++at) {
        const std::string other = library_of(by_path, (*at)[1].str());
        if (!other.empty() && other != own)
          folders[own].includes.emplace(other, file + " includes " + (*at)[1].str());
      }
    }
  }
}

void add_linked(const std::map<std::string, Folder>& folders, const std::string& name, Names& all) {
  for (const std::string& other : folders.at(name).links) {
    if (all.insert(other).second && folders.contains(other)) add_linked(folders, other, all);
  }
}

}  // namespace

TEST_CASE("a folder links what it includes, by itself or through what it links, and nothing else") {
  std::map<std::string, Folder> folders = all_folders();
  REQUIRE(folders.size() > 20);
  read_includes(folders);
  for (const auto& entry : folders) {
    const std::string& name = entry.first;
    const Folder& folder = entry.second;
    for (const std::string& other : folder.links) {
      CHECK_MESSAGE(folder.includes.contains(other), folder.path, " links ", other,
                    " and includes nothing of it");
    }
    Names linked;
    add_linked(folders, name, linked);
    for (const auto& included : folder.includes) {
      CHECK_MESSAGE(linked.contains(included.first), included.second, ", which ", folder.path,
                    " does not link");
    }
    CHECK_MESSAGE(!linked.contains(name), folder.path, " links itself in a circle");
  }
}
