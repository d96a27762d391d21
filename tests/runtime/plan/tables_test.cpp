// The tables that compiler and runtime share: sections, axes, read-outs.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "runtime/plan/axes.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/tables.h"
#include "runtime/plan/writer.h"

using namespace probe::plan;

TEST_CASE("every section is found by its number and has a name of its own") {
  std::set<std::string> names;
  for (const SectionInfo& section : all_sections()) {
    const SectionInfo* found = find_section(static_cast<std::uint32_t>(section.kind));
    REQUIRE(found != nullptr);
    CHECK(found->name == section.name);
    CHECK_MESSAGE(names.insert(section.name).second, section.name);
  }
  CHECK(find_section(0) == nullptr);
  CHECK(find_section(33) == nullptr);
}

TEST_CASE("what a writer gathers is seen in the table of its section") {
  Records records;
  records.strings = "carrot";
  records.views.resize(3);
  records.text_bytes = "use";
  const Tables tables = records.tables();
  std::size_t filled = 0;
  for_each_table(tables, [&](Section kind, const auto& table) {
    if (kind == Section::kStrings) CHECK(table.size() == 6);
    if (kind == Section::kViews) CHECK(table.size() == 3);
    filled += table.empty() ? 0 : 1;
  });
  CHECK(filled == 3);
}

TEST_CASE("axes have a bit and a name each, and those of phrases are of language") {
  std::uint32_t mask = 0;
  std::set<std::string_view> names, words;
  for (const AxisInfo& axis : kAxisTable) {
    CHECK_MESSAGE(!moves(mask, axis.axis), axis.name);
    mask |= bit(axis.axis);
    CHECK_MESSAGE(names.insert(axis.name).second, axis.name);
    CHECK_MESSAGE((!axis.is_phrase || axis.is_language()), axis.name);
    if (axis.is_language()) CHECK_MESSAGE(words.insert(axis.word()).second, axis.name);
  }
  CHECK(mask == kAllAxes);
  // Fixtures, sensors, robots, latency and what surfaces look like: bits that are given out
  // already.
  constexpr std::uint32_t kPromised = 0b111111u << 14;
  CHECK_MESSAGE(std::has_single_bit((mask | kPromised) + 1),
                "bits are given out from 0 on, none left out");
  CHECK(find_axis("language.action")->axis == Axis::kLanguageAction);
  CHECK(find_language_axis("negation")->axis == Axis::kLanguageNegation);
  CHECK(find_language_axis("layout") == nullptr);
  CHECK(axis_names(bit(Axis::kGoal) | bit(Axis::kLanguageParaphrase)) ==
        std::vector<std::string_view>{"language.paraphrase", "goal"});
}

TEST_CASE("a read-out whose last step decides is one of a condition or of no monitor at all") {
  for (const ReadoutInfo& readout : kReadoutTable) {
    CAPTURE(readout.words);
    if (!readout.has_monitor()) CHECK(readout.keeps == Keeps::kLast);
    // A number that says "never" is no number that the condition could give: steps are 1 and on.
    if (!readout.never) continue;
    CHECK(readout.takes == Kind::kBool);
    CHECK(readout.gives == Kind::kReal);
    CHECK(*readout.never < 1);
  }
  CHECK(info(Readout::kFirst).never == -1.0);
  CHECK(info(Readout::kOnce).keeps == Keeps::kEarlier);
  CHECK(info(Readout::kAlways).keeps == Keeps::kLast);
}

TEST_CASE("a read-out takes and gives what the operation that remembers for it does") {
  std::set<std::string_view> words;
  for (const ReadoutInfo& readout : kReadoutTable) {
    CAPTURE(readout.words);
    CHECK(words.insert(readout.words).second);
    CHECK(find_readout(static_cast<std::uint32_t>(readout.readout)) == &readout);
    if (!readout.has_monitor()) {
      CHECK(readout.takes == readout.gives);
      continue;
    }
    const OpInfo& op = *find_op(static_cast<std::uint8_t>(readout.monitor));
    CHECK(op.is_monitor());
    CHECK(op.b == Kind::kState);
    CHECK(op.a == readout.takes);
    CHECK(op.result == readout.gives);
    CHECK(readout_of(readout.monitor) == &readout);
  }
  std::uint32_t last = 0;
  for (const ReadoutInfo& readout : kReadoutTable)
    last = std::max(last, static_cast<std::uint32_t>(readout.readout));
  CHECK(find_readout(0) == nullptr);
  CHECK(find_readout(last + 1) == nullptr);
  CHECK(readout_of(Op::kHOLD) == nullptr);
}
