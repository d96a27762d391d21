// Damage that knows how a file or a message is built: members and values of JSON, cells and rows of
// a table, keys and arrays of a MessagePack, lengths in binary. The same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace probe::campaign {

enum class Form { kBytes, kJson, kTable, kMsgpack, kRecords };

// By the ending: .json and .jsonl, .csv, .tfrecord; anything else is bytes.
Form form_of(std::string_view name);

// Every second time of `form`, else of any bytes (scene/mutate.h). What is not of the form is
// damaged as bytes are.
std::string damaged(std::string bytes, Form form, std::uint64_t seed);

}  // namespace probe::campaign
