#include "runtime/wire/lookup.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

namespace probe::wire {
namespace {

// Owned by caller and thread: whoever is done last frees it.
struct Answer {
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Result<std::vector<Address>>> addresses;
};

// An address written as numbers, which nobody has to be asked for.
std::optional<Address> numeric(const Endpoint& server) {
  in_addr four{};
  in6_addr six{};
  if (::inet_pton(AF_INET, server.host.c_str(), &four) != 1 &&
      ::inet_pton(AF_INET6, server.host.c_str(), &six) != 1) {
    return std::nullopt;
  }
  std::uint16_t port = 0;
  const char* end = server.port.data() + server.port.size();
  if (const auto read = std::from_chars(server.port.data(), end, port);
      read.ec != std::errc() || read.ptr != end) {
    return std::nullopt;
  }
  return Address{server.host, port};
}

Failure failed(const std::string& message, const std::string& where) {
  return {Fault::kPolicy, "looking up the host" + message, where};
}

}  // namespace

Result<std::vector<Address>> system_resolver(const std::string& host, const std::string& port) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found);
  if (error != 0) return Failure{Fault::kPolicy, ::gai_strerror(error), ""};
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, ::freeaddrinfo);
  std::vector<Address> addresses;
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    char ip[NI_MAXHOST] = "", number[NI_MAXSERV] = "";
    if (::getnameinfo(at->ai_addr, at->ai_addrlen, ip, sizeof ip, number, sizeof number,
                      NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
      continue;
    }
    addresses.push_back({ip, static_cast<std::uint16_t>(std::stoul(number))});
  }
  return addresses;
}

Result<std::vector<Address>> look_up(const Endpoint& server, Duration time, Duration stated,
                                     const Resolver& resolver) {
  if (!resolver) {
    if (auto address = numeric(server)) return std::vector{std::move(*address)};
  }
  const auto answer = std::make_shared<Answer>();
  const auto ask = [answer, host = server.host, port = server.port,
                    resolve = resolver ? resolver : Resolver(system_resolver)] {
    Result<std::vector<Address>> addresses = resolve(host, port);
    const std::lock_guard lock(answer->mutex);
    answer->addresses = std::move(addresses);
    answer->changed.notify_all();
  };
  try {
    std::thread(ask).detach();
  } catch (const std::system_error& error) {
    return failed(std::string(": no thread can be started: ") + error.what(), server.name());
  }
  std::unique_lock lock(answer->mutex);
  if (!answer->changed.wait_for(lock, time, [&] { return answer->addresses.has_value(); })) {
    return failed(" took more than " + seconds_text(stated), server.name());
  }
  const Result<std::vector<Address>>& addresses = *answer->addresses;
  if (!addresses) return failed(": " + addresses.failure().message, server.name());
  if (addresses->empty()) return failed(": it has no address", server.name());
  return *addresses;
}

}  // namespace probe::wire
