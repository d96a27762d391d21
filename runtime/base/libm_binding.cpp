// ELF's dynamic relocations, as the loader has left them in memory (System V ABI, chapter 5).
#include "runtime/base/libm_binding.h"

#include <elf.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>

#include "runtime/base/trig.h"

namespace probe {
namespace {

// Of this file alone: another part of the process may have functions of the same names as ours.
double sine(double x) { return portable_sin(x); }
double cosine(double x) { return portable_cos(x); }
void sine_and_cosine(double x, double* s, double* c) {
  const SinCos both = portable_sincos(x);
  *s = both.sin;
  *c = both.cos;
}

struct Ours {
  std::string_view name;
  void* function;
};

// C and C++ functions of these arguments are called alike on every ABI that we build for.
std::array<Ours, 3> our_functions() {
  return {{{"sin", reinterpret_cast<void*>(&sine)},
           {"cos", reinterpret_cast<void*>(&cosine)},
           {"sincos", reinterpret_cast<void*>(&sine_and_cosine)}}};
}

// Relocations that put a function's address into a table, whatever the code does with it.
bool holds_address(std::uint64_t type) {
#if defined(__x86_64__)
  return type == R_X86_64_JUMP_SLOT || type == R_X86_64_GLOB_DAT || type == R_X86_64_64;
#elif defined(__aarch64__)
  return type == R_AARCH64_JUMP_SLOT || type == R_AARCH64_GLOB_DAT || type == R_AARCH64_ABS64;
#else
  return false;
#endif
}

struct Relocations {
  const ElfW(Rela) * first = nullptr;
  std::size_t count = 0;
};

std::uintptr_t page_size() { return static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE)); }

// The tables of one loaded object.
struct Tables {
  const ElfW(Sym) * symbols = nullptr;
  const char* names = nullptr;
  Relocations data, calls;
  std::uintptr_t relro_begin = 0, relro_end = 0;  // read-only since the loader was done
};

Tables read_tables(const dl_phdr_info& object) {
  Tables tables;
  // glibc has put addresses where the file has offsets; other loaders leave the offsets.
  const auto at = [&](ElfW(Addr) value) {
    return value < object.dlpi_addr ? object.dlpi_addr + value : value;
  };
  const ElfW(Dyn)* entry = nullptr;
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const auto& segment = object.dlpi_phdr[i];
    if (segment.p_type == PT_DYNAMIC) {
      entry = reinterpret_cast<const ElfW(Dyn)*>(object.dlpi_addr + segment.p_vaddr);
    } else if (segment.p_type == PT_GNU_RELRO) {
      // As the loader rounds: only whole pages can be protected.
      const std::uintptr_t begin = object.dlpi_addr + segment.p_vaddr, page = page_size();
      tables.relro_begin = begin / page * page;
      tables.relro_end = (begin + segment.p_memsz) / page * page;
    }
  }
  if (entry == nullptr) return tables;
  bool calls_have_addend = true;
  for (; entry->d_tag != DT_NULL; ++entry) {
    const ElfW(Addr) value = entry->d_un.d_ptr;
    switch (entry->d_tag) {
      case DT_SYMTAB:
        tables.symbols = reinterpret_cast<const ElfW(Sym)*>(at(value));
        break;
      case DT_STRTAB:
        tables.names = reinterpret_cast<const char*>(at(value));
        break;
      case DT_RELA:
        tables.data.first = reinterpret_cast<const ElfW(Rela)*>(at(value));
        break;
      case DT_RELASZ:
        tables.data.count = entry->d_un.d_val / sizeof(ElfW(Rela));
        break;
      case DT_JMPREL:
        tables.calls.first = reinterpret_cast<const ElfW(Rela)*>(at(value));
        break;
      case DT_PLTRELSZ:
        tables.calls.count = entry->d_un.d_val / sizeof(ElfW(Rela));
        break;
      case DT_PLTREL:
        calls_have_addend = entry->d_un.d_val == DT_RELA;
        break;
      default:
        break;
    }
  }
  if (!calls_have_addend) tables.calls = {};
  return tables;
}

// Writes one entry of a table, through the loader's protection where there is one.
Status write_slot(const Tables& tables, std::uintptr_t place, void* function) {
  auto** slot = reinterpret_cast<void**>(place);
  if (*slot == function) return {};
  if (place < tables.relro_begin || place >= tables.relro_end) {
    *slot = function;
    return {};
  }
  const std::uintptr_t page = page_size();
  auto* begin = reinterpret_cast<void*>(place / page * page);
  // A slot is aligned to its size, so that it lies in one page.
  if (::mprotect(begin, page, PROT_READ | PROT_WRITE) != 0) {
    return Failure{Fault::kWorld,
                   std::string("its sine and cosine cannot be replaced: ") + std::strerror(errno),
                   ""};
  }
  *slot = function;
  ::mprotect(begin, page, PROT_READ);
  return {};
}

bool is_part_of(const dl_phdr_info& object, std::uintptr_t address) {
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const auto& segment = object.dlpi_phdr[i];
    const std::uintptr_t begin = object.dlpi_addr + segment.p_vaddr;
    if (segment.p_type == PT_LOAD && address >= begin && address < begin + segment.p_memsz)
      return true;
  }
  return false;
}

struct Visit {
  std::span<const std::string_view> names;
  TrigBinding binding = {};
  std::optional<Failure> failure = {};

  Status bind(const dl_phdr_info& object) {
    const Tables tables = read_tables(object);
    if (tables.symbols == nullptr || tables.names == nullptr) return {};
    for (const Relocations& list : {tables.data, tables.calls}) {
      for (std::size_t i = 0; i < list.count; ++i) {
        const ElfW(Rela)& relocation = list.first[i];
        if (!holds_address(ELF64_R_TYPE(relocation.r_info)) || relocation.r_addend != 0) continue;
        const ElfW(Sym)& symbol = tables.symbols[ELF64_R_SYM(relocation.r_info)];
        const std::string_view called(tables.names + symbol.st_name);
        for (const Ours& ours : our_functions()) {
          if (called != ours.name) continue;
          PROBE_TRY(write_slot(tables, object.dlpi_addr + relocation.r_offset, ours.function));
          ++binding.slots;
        }
      }
    }
    return {};
  }

  int visit(const dl_phdr_info& object) {
    const std::string_view path = object.dlpi_name == nullptr ? "" : object.dlpi_name;
    const std::string_view file = path.substr(path.rfind('/') + 1);
    const bool is_named = !file.empty() && std::ranges::any_of(names, [&](std::string_view name) {
      return file.starts_with(name);
    });
    if (!is_named && !is_part_of(object, reinterpret_cast<std::uintptr_t>(&sine_and_cosine)))
      return 0;
    ++binding.libraries;
    if (auto bound = bind(object); !bound) {
      failure = bound.failure();
      failure->where = std::string(path);
      return 1;
    }
    return 0;
  }
};

}  // namespace

Result<TrigBinding> bind_trigonometry(std::span<const std::string_view> names) {
  static std::mutex mutex;  // two threads must not undo each other's protection
  const std::lock_guard lock(mutex);
  Visit visit{names};
  ::dl_iterate_phdr([](dl_phdr_info* object, std::size_t,
                       void* data) { return static_cast<Visit*>(data)->visit(*object); },
                    &visit);
  if (visit.failure) return *visit.failure;
  return visit.binding;
}

}  // namespace probe
