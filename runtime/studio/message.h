// What goes to the page: JSON as text, and pictures as bytes behind their JSON.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "runtime/base/json.h"
#include "runtime/stage/scene_view.h"
#include "runtime/wire/page_listener.h"

namespace probe::studio {

// {kind, id, message} with more as the kind has it.
wire::Frame message(const Json& json);

// Four bytes, little-endian, how many bytes of JSON follow; that JSON, with the pictures' `cameras`
// [{name, width, height}] added; then each picture's pixels, rows from the top, four bytes each as
// a canvas takes them.
wire::Frame picture_message(Json json, std::span<const stage::CameraFrame> frames);

}  // namespace probe::studio
