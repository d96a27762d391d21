#include "runtime/api/calls.h"

#include <cstdlib>
#include <cstring>
#include <iterator>

namespace probe::api {
namespace {

constexpr Fault kFaults[] = {
#define PROBE_FAULT(name, word) Fault::name,
#include "runtime/base/faults.def"
#undef PROBE_FAULT
};

// A fault's code is its place in faults.def, from 1 on: new ones go to the end of both.
static_assert(VLAPROBE_USAGE == static_cast<int>(Fault::kUsage) + 1);
static_assert(VLAPROBE_WORLD == static_cast<int>(Fault::kWorld) + 1);
static_assert(VLAPROBE_ANSWERED == static_cast<int>(Fault::kAnswered) + 1);
static_assert(VLAPROBE_TRACE == static_cast<int>(Fault::kTrace) + 1);
static_assert(VLAPROBE_INTERNAL == static_cast<int>(Fault::kInternal) + 1);
static_assert(VLAPROBE_NO_SKILL == static_cast<int>(Fault::kNoSkill) + 1);
static_assert(VLAPROBE_NO_SKILL == std::size(kFaults));

// Of the codes that are no fault.
struct Word {
  std::int32_t code;
  const char* word;
};
constexpr Word kWords[] = {{VLAPROBE_OK, "ok"},
                           {VLAPROBE_TEXT, "text"},
                           {VLAPROBE_MEMORY, "memory"},
                           {VLAPROBE_STOPPED, "stopped"}};

constexpr const char* kNoMemory = "out of memory";

}  // namespace

std::int32_t code_of(Fault fault) { return static_cast<std::int32_t>(fault) + 1; }

char* copy_text(std::string_view text) {
  auto* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) return nullptr;
  std::memcpy(copy, text.data(), text.size());
  copy[text.size()] = '\0';
  return copy;
}

std::int32_t fail(vlaprobe_error* error, const Failure& failure) {
  const std::int32_t code = code_of(failure.code);
  if (error == nullptr) return code;
  vlaprobe_error_clear(error);
  error->code = code;
  error->message = copy_text(to_text(failure));
  error->where = copy_text(failure.where);
  return code;
}

std::int32_t fail(vlaprobe_error* error, std::int32_t code, std::string_view message,
                  std::string_view diagnostics) {
  if (error == nullptr) return code;
  vlaprobe_error_clear(error);
  error->code = code;
  error->message = copy_text(message);
  error->where = copy_text("");
  if (!diagnostics.empty()) error->diagnostics = copy_text(diagnostics);
  return code;
}

std::int32_t fail_memory(vlaprobe_error* error) {
  return fail(error, VLAPROBE_MEMORY, kNoMemory, {});
}

Status needs(std::initializer_list<Needed> arguments) {
  for (const Needed& one : arguments) {
    if (one.given == nullptr) return usage("`" + std::string(one.name) + "` is NULL");
  }
  return {};
}

Result<std::vector<std::string>> read_texts(const char* const* texts, std::size_t count,
                                            const char* name) {
  if (count > 0) PROBE_TRY(needs({{texts, name}}));
  std::vector<std::string> read;
  for (std::size_t i = 0; i < count; ++i) {
    if (texts[i] == nullptr)
      return usage("`" + std::string(name) + "` has NULL at " + std::to_string(i));
    read.emplace_back(texts[i]);
  }
  return read;
}

}  // namespace probe::api

extern "C" {

int32_t vlaprobe_api_version(void) { return VLAPROBE_API_VERSION; }

const char* vlaprobe_version(void) { return VLAPROBE_VERSION; }

void vlaprobe_error_clear(vlaprobe_error* error) {
  if (error == nullptr) return;
  std::free(error->message);
  std::free(error->where);
  std::free(error->diagnostics);
  *error = {};
}

const char* vlaprobe_code_word(int32_t code) {
  using namespace probe;
  for (const api::Word& known : api::kWords) {
    if (known.code == code) return known.word;
  }
  for (const Fault fault : api::kFaults) {
    if (api::code_of(fault) == code) return to_word(fault).data();  // of string literals
  }
  return "unknown";
}

void vlaprobe_free(void* memory) { std::free(memory); }
}
