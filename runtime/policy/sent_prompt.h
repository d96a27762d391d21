// How an instruction may be written anew for a server (what a profile can ask for), and by that all
// texts that an episode's instruction can have been sent as.
#pragma once

#include <string>
#include <string_view>

namespace probe::policy {

std::string in_lower_case(std::string text);  // of A to Z alone
std::string with_full_stop(std::string text);
std::string without_full_stop(std::string text);

// Whether `sent` is, in hex, the hash of what some profile makes of `prompt`.
bool can_be_sent_as(const std::string& prompt, std::string_view sent);

}  // namespace probe::policy
