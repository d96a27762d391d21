// Files as editors name them.
#pragma once

#include <string>
#include <string_view>

namespace probe::lsp {

// Of "file:///a%20b.probe" "/a b.probe", lexically normal. What is no file of this machine, such as
// a text that was never saved, is called by its whole address.
std::string path_of(std::string_view uri);
std::string uri_of(std::string_view path);

}  // namespace probe::lsp
