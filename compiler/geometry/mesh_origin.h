// Where a mesh of a text is read from, in words for messages: a name that the program's own assets
// have, too, is easily taken for a file beside the text.
#pragma once

#include <string>

#include "runtime/base/asset_root.h"

namespace probe::sema {

// Which folder of assets has it: "`objects/mug` of the program's own assets", ".. beside the text",
// ".. of `../assets`".
std::string origin_of(const AssetRoot& asset_root, const std::string& text,
                      const std::string& mesh);

// A mesh file called `mesh`, or `mesh` with an ending of such files, beside the text at `text` or
// in its `assets`; empty where there is none. No folder of meshes.
std::string file_beside(const std::string& text, const std::string& mesh);

// What makes a folder of such a file, or of any: "a mesh is a folder: `vlaprobe assets pack mug.obj
// -o assets/objects/my_mug` makes one of `mug.obj`".
std::string pack_advice(const std::string& text, const std::string& mesh);

}  // namespace probe::sema
