// The kinds of files and messages that readers.cpp damages: what a whole one looks like, and what
// reads it. A family of kinds a file, kinds_*.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "tests/campaigns/damage.h"

namespace probe::campaign {

struct Sample {
  std::string name;  // of the file, its ending says the form
  std::string bytes;
};

// A sample as it is read.
struct Given {
  std::string name;          // the sample's
  std::string path;          // where it lies
  const std::string& bytes;  // what is in it
  bool is_whole;             // nothing is damaged
};

struct Kind {
  const char* name;
  std::vector<Sample> samples;
  std::function<Status(const Given& file)> read;
  // Where bytes of one form are not all that there is to damage; none: as the name's ending says.
  std::function<std::string(std::string bytes, std::uint64_t seed)> damage = nullptr;
  bool waits = false;  // for who does not answer: has fewer turns
};

std::string text_of(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& bytes);
// By name, with all folders below; `ending` empty: any. Names are relative to `folder`.
std::vector<Sample> files_in(const std::filesystem::path& folder, const std::string& ending,
                             std::size_t most_bytes = 100'000);

inline std::span<const std::uint8_t> octets(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}
inline std::string text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <typename T>
Status status_of(const Result<T>& result) {
  return result.ok() ? Status() : Status(result.failure());
}

// Makes samples in a process of its own, so that this one has no threads when it forks again. Ends
// the program with the reason where it fails.
void make_apart(const char* what, const std::function<Status()>& make);

// `work` is a folder of the campaign's own.
void add_files(std::vector<Kind>& kinds, const std::filesystem::path& work);
void add_folders(std::vector<Kind>& kinds, const std::filesystem::path& work);
void add_messages(std::vector<Kind>& kinds);
void add_conversations(std::vector<Kind>& kinds, const std::filesystem::path& work);

}  // namespace probe::campaign
