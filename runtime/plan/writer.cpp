#include "runtime/plan/writer.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/check.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/verify.h"

namespace probe::plan {
namespace {

struct Part {
  DirectoryEntry entry;
  std::span<const std::byte> bytes;
};

// The canonical layout: header, directory, sections each at the next multiple of 64, zeros between,
// none at the end.
std::vector<std::byte> join(std::span<Part> parts) {
  std::uint64_t end = sizeof(Header) + parts.size() * sizeof(DirectoryEntry);
  for (Part& part : parts) {
    part.entry.offset = align_up(end);
    end = part.entry.offset + part.entry.size;
  }
  std::vector<DirectoryEntry> directory;
  for (const Part& part : parts) directory.push_back(part.entry);

  Header header;
  header.minor = kMinor;
  header.sections = static_cast<std::uint32_t>(parts.size());
  header.file_size = end;
  header.root = root_hash(header, directory).bytes;

  std::vector<std::byte> out(end);
  std::memcpy(out.data(), &header, sizeof header);
  if (!directory.empty()) {
    std::memcpy(out.data() + sizeof header, directory.data(),
                directory.size() * sizeof(DirectoryEntry));
  }
  for (const Part& part : parts) {
    std::memcpy(out.data() + part.entry.offset, part.bytes.data(), part.bytes.size());
  }
  return out;
}

std::uint32_t to_u32(std::size_t size) {
  PROBE_CHECK(size < kNone, "a section has fewer than 2^32 - 1 records");
  return static_cast<std::uint32_t>(size);
}

}  // namespace

Tables Records::tables() const {
  Tables out;
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) out.member = member;
#include "runtime/plan/sections.def"
  return out;
}

StringRef Writer::text(std::string_view value) {
  // The empty string is (0, 0) wherever it is first used, so that default references already are
  // it.
  if (value.empty()) return {};
  const auto [it, is_new] = interned_.try_emplace(std::string(value));
  if (is_new) {
    it->second = {to_u32(records.strings.size()), to_u32(value.size())};
    records.strings.append(value);
  }
  return it->second;
}

Slice Writer::list(std::span<const std::uint32_t> values) { return append(records.list, values); }
Slice Writer::reals(std::span<const double> values) { return append(records.reals, values); }

std::uint32_t Writer::source(std::string_view path, std::string_view bytes) {
  TextRecord record;
  record.path = {to_u32(records.text_bytes.size()), to_u32(path.size())};
  records.text_bytes.append(path);
  record.bytes = {to_u32(records.text_bytes.size()), to_u32(bytes.size())};
  records.text_bytes.append(bytes);
  records.texts.push_back(record);
  return to_u32(records.texts.size() - 1);
}

void Writer::fill_ids() {
  const Tables tables = records.tables();
  for (ProgramRecord& program : records.programs)
    program.hash = program_hash(tables, program).bytes;
  IdHasher ids(tables);
  for (TaskRecord& task : records.tasks) task.judge_id = ids.judge(task).bytes;
  for (EpisodeRecord& episode : records.episodes) {
    const TaskRecord& task = records.tasks[episode.task];
    episode.start_id = ids.start(task, episode).bytes;
    episode.episode_id = ids.episode(task, episode).bytes;
  }
  for (QuestionRecord& question : records.questions)
    question.question_id = question_id(tables, question).bytes;
}

std::vector<std::byte> Writer::lay_out() const {
  const Tables tables = records.tables();
  std::vector<Part> parts;
  for_each_table(tables, [&](Section kind, const auto& table) {
    if (table.empty()) return;  // a section without records is left out
    const SectionInfo& info = *find_section(static_cast<std::uint32_t>(kind));
    Part part;
    part.bytes = std::as_bytes(std::span(table.data(), table.size()));
    part.entry.kind = static_cast<std::uint32_t>(kind);
    part.entry.flags = info.ignorable ? kIgnorable : std::uint16_t{0};
    part.entry.size = part.bytes.size();
    part.entry.count = to_u32(table.size());
    part.entry.stride = info.stride;
    part.entry.sha256 = sha256(part.bytes).bytes;
    parts.push_back(part);
  });
  return join(parts);
}

Result<std::vector<std::byte>> Writer::finish(const VerifyOptions& options) {
  // Those of one thing keep the order in which they were added.
  std::ranges::stable_sort(records.spans, {},
                           [](const SpanRecord& s) { return std::pair(s.what, s.index); });
  // Ids follow indices, so tables are looked at before ids are computed, and the bytes once more
  // afterwards.
  std::vector<std::byte> bytes = lay_out();
  PROBE_TRY(verify(bytes, {.identity = false}));
  fill_ids();
  bytes = lay_out();
  PROBE_TRY(verify(bytes, options));
  return bytes;
}

}  // namespace probe::plan
