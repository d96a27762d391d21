// Reads what the loader and the kernel say about this process: build ids of the program and of the
// libraries that compute.
#include "runtime/store/fingerprint.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/world/multibody.h"

namespace probe::store {
namespace {

// Libraries whose code can change a state or a picture, by the start of their file name.
constexpr std::array<std::pair<const char*, const char*>, 14> kLibraries = {{
    {"libSimTKsimbody", "simbody"},
    {"libSimTKmath", "simtk_math"},
    {"libSimTKcommon", "simtk_common"},
    {"libembree", "embree"},
    {"libassimp", "assimp"},
    {"libpng", "png"},
    {"libm.so", "libm"},
    {"libm-", "libm"},
    {"libblas", "blas"},
    {"libopenblas", "openblas"},
    {"libmkl_rt", "mkl"},
    {"liblapack", "lapack"},
    {"libcholmod", "cholmod"},
    {"libnlopt", "nlopt"},
}};

std::string build_id(const dl_phdr_info& info) {
  for (int i = 0; i < info.dlpi_phnum; ++i) {
    const auto& segment = info.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* at = reinterpret_cast<const char*>(info.dlpi_addr + segment.p_vaddr);
    const char* end = at + segment.p_memsz;
    while (end - at >= static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const std::size_t name = (note.n_namesz + 3u) & ~3u;
      const std::size_t size = (note.n_descsz + 3u) & ~3u;
      const char* bytes = at + sizeof note + name;
      if (bytes + size > end) break;
      if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4) {
        std::string text;
        for (std::size_t k = 0; k < note.n_descsz; ++k) {
          constexpr char kDigits[] = "0123456789abcdef";
          const auto byte = static_cast<unsigned char>(bytes[k]);
          text += kDigits[byte >> 4];
          text += kDigits[byte & 15];
        }
        return text;
      }
      at = bytes + size;
    }
  }
  return {};
}

int visit_object(dl_phdr_info* info, std::size_t, void* data) {
  auto& entries = *static_cast<std::map<std::string, std::string>*>(data);
  const std::string path = info->dlpi_name == nullptr ? "" : info->dlpi_name;
  if (path.empty()) {  // the program itself comes first, without a name
    if (!entries.contains("program")) entries["program"] = build_id(*info);
    return 0;
  }
  const std::string file = path.substr(path.rfind('/') + 1);
  for (const auto& [start, name] : kLibraries) {
    if (file.starts_with(start)) entries[name] = file + " " + build_id(*info);
  }
  return 0;
}

// Keeps the build id of the object in which own_build_id() lies.
int visit_own(dl_phdr_info* info, std::size_t, void* data) {
  const auto at = reinterpret_cast<ElfW(Addr)>(&own_build_id);
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& segment = info->dlpi_phdr[i];
    const ElfW(Addr) begin = info->dlpi_addr + segment.p_vaddr;
    if (segment.p_type != PT_LOAD || at < begin || at >= begin + segment.p_memsz) continue;
    *static_cast<std::string*>(data) = build_id(*info);
    return 1;
  }
  return 0;
}

std::string program_hash() {
  const auto bytes = read_file("/proc/self/exe");
  return to_hex(sha256(bytes ? *bytes : std::string()));
}

// Vendor, family and the instruction sets that libraries choose their code by; not the clock or the
// model's name.
std::string cpu_family() {
  const auto text = read_file("/proc/cpuinfo");
  std::istringstream file(text ? *text : std::string());
  std::string line, vendor, family, sets;
  while (std::getline(file, line) && !line.empty()) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string name = line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1);
    const std::string value = colon + 2 <= line.size() ? line.substr(colon + 2) : "";
    if (name == "vendor_id") vendor = value;
    if (name == "cpu family") family = value;
    if (name != "flags") continue;
    const std::string padded = " " + value + " ";
    for (const char* set : {"sse4_2", "avx", "fma", "avx2", "avx512f", "avx512vl"}) {
      if (padded.find(std::string(" ") + set + " ") != std::string::npos) {
        sets += std::string(" ") + set;
      }
    }
  }
  return vendor + " family " + family + sets;
}

}  // namespace

Fingerprint take_fingerprint(const Sha256& assets) {
  std::map<std::string, std::string> entries;
  dl_iterate_phdr(visit_object, &entries);
  if (entries["program"].empty()) entries["program"] = program_hash();
  // Linked statically it is part of the program, whose build id tells builds apart.
  entries.try_emplace("simbody", "static " + world::multibody_build().version);
  entries["compiler"] = __VERSION__;
  entries["cpu"] = cpu_family();
  entries["assets"] = to_hex(assets);
  return {{entries.begin(), entries.end()}};
}

std::string own_build_id() {
  std::string id;
  dl_iterate_phdr(visit_own, &id);
  return id;
}

std::string to_json(const Fingerprint& fingerprint) {
  Json json = Json::object();
  for (const auto& [name, value] : fingerprint.entries) json[name] = value;
  return json.sorted().dump();
}

Result<Fingerprint> fingerprint_from_json(std::string_view text) {
  const Json json = Json::parse(text);
  Fingerprint fingerprint;
  if (!json.is_object()) return Failure{Fault::kStore, "a fingerprint is not a JSON object", ""};
  for (const auto& [name, value] : json.items()) {
    if (!value.is_string())
      return Failure{Fault::kStore, "fingerprint entry `" + name + "` is no text", ""};
    fingerprint.entries.emplace_back(name, value.get<std::string>());
  }
  std::sort(fingerprint.entries.begin(), fingerprint.entries.end());
  return fingerprint;
}

std::vector<std::string> differences(const Fingerprint& recorded, const Fingerprint& here) {
  std::map<std::string, std::pair<std::string, std::string>> all;
  for (const auto& [name, value] : recorded.entries) all[name].first = value;
  for (const auto& [name, value] : here.entries) all[name].second = value;
  std::vector<std::string> lines;
  for (const auto& [name, values] : all) {
    if (values.first == values.second) continue;
    const auto said = [](const std::string& text) { return text.empty() ? "nothing" : text; };
    lines.push_back(name + ": recorded " + said(values.first) + ", here " + said(values.second));
  }
  return lines;
}

}  // namespace probe::store
