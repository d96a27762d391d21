// Conversations with the projects' own serving code, written down in tests/servers/transcripts, and
// how such a server is asked.
#pragma once

#include <string>

#include "runtime/servers/protocol.h"

namespace probe::test {

struct RecordedServer {
  servers::Protocol protocol;
  const char *name, *options;  // of the file; beside the address, with & before each

  std::string file() const { return std::string(name) + ".transcript"; }
  std::string path() const { return VLAPROBE_SOURCE_DIR "/tests/servers/transcripts/" + file(); }
};

inline constexpr RecordedServer kRecordedServers[] = {
    {servers::Protocol::kOpenpi, "openpi", ""},
    {servers::Protocol::kRoboArena, "roboarena", ""},
    {servers::Protocol::kIntact, "intact", "&model=/m&profile=pi0_bridge"},
    {servers::Protocol::kStarVla, "starvla", ""},
    {servers::Protocol::kVlaEval, "vlaeval", ""},
    {servers::Protocol::kGr00t, "gr00t_n1.6", "&profile=gr00t_bridge&dialect=n1.6"},
    {servers::Protocol::kGr00t, "gr00t_n1.6_nested", "&profile=gr00t_bridge&dialect=n1.6_nested"},
    {servers::Protocol::kGr00t, "gr00t_n1.5", "&profile=gr00t_bridge&dialect=n1.5"},
    {servers::Protocol::kOpenVla, "openvla", "&profile=openvla_bridge"},
    {servers::Protocol::kOpenVla, "openvla_encoded", "&profile=openvla_bridge&dialect=encoded"},
    {servers::Protocol::kLeRobot, "lerobot",
     "&type=smolvla&model=/m&device=cpu&action.form=delta&action.units=m_rad&action.rotation="
     "vector&action.gripper=signed&action.threshold=none&chunk.length=2"}};

}  // namespace probe::test
