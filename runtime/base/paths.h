// Questions to the file system that never throw: what cannot be asked (no permission, a loop of
// links, a name too long) is answered with "no". Files are read and written in file.h.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe {

// What a path leads to, links followed.
bool is_there(const std::string& path);  // anything at all
bool is_file(const std::string& path);   // a regular file
bool is_folder(const std::string& path);
// The path itself, links not followed.
bool is_link(const std::string& path);
// Whether two paths lead to one file or folder that is there.
bool is_same(const std::string& a, const std::string& b);

// Normal in the lexical sense; only normal where the working folder is gone.
std::string absolute_path(const std::string& path);

// Names of what is in a folder, ascending, without "." and "..". Fails (kIo, where = path).
Result<std::vector<std::string>> list_folder(const std::string& path);

// The folder and those above it. Fails (kIo, where = path).
Status make_folders(const std::string& path);

// Waits until the names in a folder are on the disk. Fails (kIo, where = path).
Status sync_folder(const std::string& path);

// make_folders, after which the names of the new folders are on the disk too.
Status make_lasting_folders(const std::string& path);

}  // namespace probe
