// Conversations written down and played back, on every protocol.
#include "runtime/servers/transcript.h"

#include <doctest/doctest.h>

#include "runtime/base/file.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/servers/recorded_servers.h"

namespace probe::servers {
namespace {

ServerChoice choice_of(Protocol protocol, const std::string& port, const ServeOptions& options) {
  auto choice =
      choose_server(protocol, "//127.0.0.1:" + port + "?" + options_for_served(protocol, options));
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  return std::move(*choice);
}

// All that a test found but times and addresses.
std::string findings(const ServerChoice& choice) {
  const auto tested = test_server(choice);
  REQUIRE_MESSAGE(tested.ok(), to_text(tested.failure()));
  std::string text = std::to_string(tested->queries) + " answers\n";
  for (const std::string& remark : tested->remarks) text += remark + "\n";
  for (const Check& check : tested->checks) {
    if (check.name == "latency" || check.name == "connection") continue;
    text += std::string(to_word(check.verdict)) + " " + check.name + " " + check.found + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("a recorded conversation is played back as it was, on every protocol") {
  for (const Protocol protocol : all_protocols()) {
    CAPTURE(std::string(to_word(protocol)));
    ServeOptions options;
    options.policy = serve_digest().value();
    auto server = serve(protocol, options);
    REQUIRE_MESSAGE(server.ok(), to_text(server.failure()));
    const ServerChoice there = choice_of(protocol, (*server)->port(), options);
    const std::string original = findings(there);
    CHECK(original.find("fine instruction another instruction has another answer") !=
          std::string::npos);
    const auto recorded = record(there);
    REQUIRE_MESSAGE(recorded.ok(), to_text(recorded.failure()));
    server->reset();  // gone

    // Through the file, without what was asked.
    const auto kept = parse_transcript(to_text(*recorded, false), "t");
    REQUIRE_MESSAGE(kept.ok(), to_text(kept.failure()));
    CHECK(kept->connections.size() == recorded->connections.size());
    std::vector<std::string> told;
    const auto player = play(*kept, "127.0.0.1", "0",
                             [&](const std::string& sentence) { told.push_back(sentence); });
    REQUIRE_MESSAGE(player.ok(), to_text(player.failure()));
    CHECK(findings(choice_of(protocol, (*player)->port(), options)) == original);
    if (protocol != Protocol::kRoboArena) CHECK(told.empty());  // each session has another name
  }
}

TEST_CASE("the projects' own serving code is asked as when it was recorded, and understood") {
  for (const test::RecordedServer& real : test::kRecordedServers) {
    CAPTURE(real.file());
    const auto text = read_file(real.path());
    REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
    const auto transcript = parse_transcript(*text, real.path());
    REQUIRE_MESSAGE(transcript.ok(), to_text(transcript.failure()));
    CHECK(transcript->protocol == real.protocol);
    std::vector<std::string> told;
    const auto player = play(*transcript, "127.0.0.1", "0",
                             [&](const std::string& sentence) { told.push_back(sentence); });
    REQUIRE_MESSAGE(player.ok(), to_text(player.failure()));
    const auto choice = choose_server(
        real.protocol, "//127.0.0.1:" + (*player)->port() + "?timeout.wait_s=1" + real.options);
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    const std::string found = findings(*choice);
    CAPTURE(found);
    CHECK(found.find("11 answers") == 0);
    CHECK(found.find("fine sameness") != std::string::npos);
    CHECK(found.find("fine picture") != std::string::npos);
    CHECK(found.find("fine instruction") != std::string::npos);
    CHECK(found.find("wrong ") == std::string::npos);
    // Byte for byte what was asked then; sessions have a name of their own each time, and some
    // messages the time.
    if (real.protocol != Protocol::kRoboArena && !row_of(real.protocol).is_timed)
      CHECK(told.empty());
  }
}

TEST_CASE("a transcript reads back equal, with questions or with their hashes") {
  Transcript transcript;
  transcript.protocol = Protocol::kRoboArena;
  transcript.connections = {{line_of(false, {false, {0x80}}), line_of(true, {false, {1, 2, 3}}),
                             line_of(false, wire::text_frame("reset successful"))},
                            {}};
  const auto whole = parse_transcript(to_text(transcript, true), "t");
  REQUIRE_MESSAGE(whole.ok(), to_text(whole.failure()));
  CHECK(*whole == transcript);
  const std::string text = to_text(transcript, false);
  CHECK(text.find("> bin 3 sha256 "
                  "039058c6f2c0cb492c533b0a4d14ef77cc0f78abccced5287d84a1a2011cfb81") !=
        std::string::npos);
  CHECK(text.find("< text hex 7265736574207375636365737366756c\n") != std::string::npos);
  const auto hashes = parse_transcript(text, "t");
  REQUIRE_MESSAGE(hashes.ok(), to_text(hashes.failure()));
  CHECK(hashes->connections[0][1].frame.bytes.empty());
  CHECK(to_text(*hashes, true) == text);
}

TEST_CASE("what is no transcript is refused at its line") {
  const std::string head = "vlaprobe transcript 1\nprotocol openpi\n";
  const auto place_of = [](const std::string& text) {
    const auto read = parse_transcript(text, "file");
    REQUIRE_FALSE(read.ok());
    CHECK(read.failure().code == Fault::kUsage);
    return read.failure().where;
  };
  CHECK(place_of("") == "file:0");
  CHECK(place_of("transcript\n") == "file:1");
  CHECK(place_of("vlaprobe transcript 1\nprotocol smoke\n") == "file:2");
  CHECK(place_of(head) == "file:2");
  CHECK(place_of(head + "< bin hex 80\n") == "file:3");
  CHECK(place_of(head + "connection\n< bin hex 8\n") == "file:4");
  CHECK(place_of(head + "connection\n< bin hex 8G\n") == "file:4");
  CHECK(place_of(head + "connection\n< bin 1 sha256 00\n") == "file:4");
  CHECK(place_of(head + "connection\n> bin -1 sha256 00\n") == "file:4");
  CHECK(place_of(head + "connection\n? bin hex 80\n") == "file:4");
}

TEST_CASE("a question beyond the transcript's end ends the connection with a reason") {
  Transcript transcript;
  transcript.connections = {{line_of(false, {false, {0x80}})}};
  const auto player = play(transcript, "127.0.0.1", "0");
  REQUIRE_MESSAGE(player.ok(), to_text(player.failure()));
  const auto tested = test_server(choice_of(Protocol::kOpenpi, (*player)->port(), {}));
  REQUIRE_MESSAGE(tested.ok(), to_text(tested.failure()));
  CHECK(tested->is_wrong());
  CHECK(tested->checks.at(1).found.find("the transcript ends before question 1") !=
        std::string::npos);
}

}  // namespace probe::servers
