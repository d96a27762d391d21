// What can be placed in a picture at all: the rules of whoever draws, whatever it draws with.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/render/renderer.h"

namespace probe::render {

// Fails (kRender, at the visual's name) on an origin that is not finite or not a rotation.
Status check_origin(const Visual& visual);

// One pose each of `count` visuals, finite, rigid, within 1000 km. Fails (kRender) naming the
// visual by `name_of`.
Status check_poses(std::span<const Pose> poses, std::size_t count,
                   const std::function<std::string(std::size_t)>& name_of);

}  // namespace probe::render
