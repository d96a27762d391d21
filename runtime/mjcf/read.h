// Reads an MJCF file into plain data. Knows nothing of assets, plans or worlds, and opens no mesh
// and no picture.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/mjcf/model.h"

namespace probe::mjcf {

struct ReadOptions {
  // The MJCF that the model is made a part of, as robosuite does with its base.xml: that file's
  // `compiler` holds and the model's own is not read, and meshes and textures are found beside the
  // model, without any meshdir. Empty: the model alone, as MuJoCo reads it.
  std::string merged_into;
};

// What is known and not read (equality, tendon, actuator, ...) is a note with its place. Fails
// (kAsset, where = FILE:LINE) as read_document does, on an element, attribute or word that MJCF has
// not, a number that is none or not finite, too few or too many numbers, a size, mass or density
// below 0, a class, mesh, material or texture that is not there, two bodies, joints or classes of
// one name. A second mesh, material or texture of one name is a note, and the first counts, as
// robosuite takes it; a second geom or site of one name is a note, and both count.
Result<Model> read_model(const std::string& path, const ReadOptions& options = {});

}  // namespace probe::mjcf
