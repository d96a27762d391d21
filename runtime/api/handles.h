// What is behind the handles that step worlds.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/api/calls.h"
#include "runtime/api/vlaprobe.h"
#include "runtime/api/world.h"
#include "runtime/api/worlds.h"

struct vlaprobe_stage {
  probe::api::Use::Lock lock;
  std::shared_ptr<probe::api::World> world;       // with the policies that act in it
  bool has_pictures = true, is_observed = false;  // of what is now
  std::vector<std::byte> saved;                   // the last bytes given
};

struct vlaprobe_batch {
  probe::api::Use::Lock lock;
  std::unique_ptr<probe::api::Worlds> worlds;
};
