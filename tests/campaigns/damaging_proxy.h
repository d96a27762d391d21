// Between a client and a server on this machine: the bytes of either side go on, some of them
// damaged, lost, cut off or in pieces. What carries messages reads such bytes before anybody knows
// what they are.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace probe::campaign {

// Of each connection the byte `at` of what one side says.
struct StreamDamage {
  enum class What { kBit, kByte, kCut, kLost, kMore, kTwice, kLength, kPieces, kSilence };
  static constexpr std::size_t kWhats = 9;
  bool is_asked = false;  // by the client; else answered
  std::size_t at = 0;
  What what = What::kBit;
  std::size_t number = 0;
};

// Closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int operator*() const { return number_; }

 private:
  int number_;
};

// A socket of 127.0.0.1 that listens at a free port.
class LocalListener {
 public:
  LocalListener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place = address(0);
    socklen_t size = sizeof place;
    ::bind(*socket_, reinterpret_cast<sockaddr*>(&place), size);
    ::listen(*socket_, 64);
    ::getsockname(*socket_, reinterpret_cast<sockaddr*>(&place), &size);
    port_ = ntohs(place.sin_port);
  }
  static sockaddr_in address(std::uint16_t port) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return place;
  }
  int socket() const { return *socket_; }
  std::string port() const { return std::to_string(port_); }
  Descriptor accept() const {
    Descriptor taken(::accept4(*socket_, nullptr, nullptr, SOCK_CLOEXEC));
    const timeval second{1, 0};  // nobody waits for who does not read
    ::setsockopt(*taken, SOL_SOCKET, SO_SNDTIMEO, &second, sizeof second);
    return taken;
  }

 private:
  Descriptor socket_;
  std::uint16_t port_ = 0;
};

inline bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

class DamagingProxy {
 public:
  DamagingProxy(const std::string& server_port, std::vector<StreamDamage> damages)
      : server_(static_cast<std::uint16_t>(std::stoi(server_port))), damages_(std::move(damages)) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) == 0) over_ = Descriptor(ends[0]), end_ = Descriptor(ends[1]);
    thread_ = std::thread([this] { run(); });
  }
  ~DamagingProxy() {
    end_ = Descriptor();
    thread_.join();
  }
  std::string port() const { return listener_.port(); }

 private:
  struct Side {
    Descriptor socket;
    std::size_t passed = 0;  // bytes that came from there
    bool is_mute = false;
  };
  struct Pair {
    std::array<Side, 2> sides;  // client, server
  };

  void run() {
    std::vector<std::unique_ptr<Pair>> pairs;
    while (true) {
      std::vector<pollfd> waits = {{*over_, POLLIN, 0}, {listener_.socket(), POLLIN, 0}};
      for (const auto& pair : pairs) {
        for (const Side& side : pair->sides) waits.push_back({*side.socket, POLLIN, 0});
      }
      if (::poll(waits.data(), waits.size(), -1) < 0 || waits[0].revents != 0) return;
      for (std::size_t i = pairs.size(); i-- > 0;) {
        bool stands = true;
        for (std::size_t from = 0; from < 2 && stands; ++from) {
          if (waits[2 + 2 * i + from].revents != 0) stands = pass(*pairs[i], from);
        }
        if (!stands) pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(i));
      }
      if (waits[1].revents != 0) open(pairs);
    }
  }

  void open(std::vector<std::unique_ptr<Pair>>& pairs) {
    auto pair = std::make_unique<Pair>();
    pair->sides[0].socket = listener_.accept();
    pair->sides[1].socket = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in place = LocalListener::address(server_);
    const timeval second{1, 0};
    ::setsockopt(*pair->sides[1].socket, SOL_SOCKET, SO_SNDTIMEO, &second, sizeof second);
    if (*pair->sides[0].socket >= 0 &&
        ::connect(*pair->sides[1].socket, reinterpret_cast<const sockaddr*>(&place),
                  sizeof place) == 0)
      pairs.push_back(std::move(pair));
  }

  // False: the connection is over.
  bool pass(Pair& pair, std::size_t from) {
    Side& side = pair.sides[from];
    std::string bytes(16'384, '\0');
    const ssize_t read = ::recv(*side.socket, bytes.data(), bytes.size(), 0);
    if (read <= 0) return false;
    bytes.resize(static_cast<std::size_t>(read));
    const int to = *pair.sides[1 - from].socket;
    const std::size_t begin = side.passed, end = begin + bytes.size();
    side.passed = end;
    if (side.is_mute) return true;
    bool goes_on = true, in_pieces = false;
    for (const StreamDamage& damage : damages_) {
      if (damage.is_asked != (from == 0) || damage.at < begin || damage.at >= end) continue;
      const std::size_t at = std::min(damage.at - begin, bytes.size());
      apply(damage, at, bytes);
      if (damage.what == StreamDamage::What::kCut) goes_on = false;
      if (damage.what == StreamDamage::What::kSilence) side.is_mute = true;
      if (damage.what == StreamDamage::What::kPieces) in_pieces = true;
    }
    if (in_pieces) {
      for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 300); ++i) {
        if (!send_all(to, std::string_view(bytes).substr(i, 1))) return false;
      }
      bytes.erase(0, 300);
    }
    return send_all(to, bytes) && goes_on;
  }

  static void apply(const StreamDamage& damage, std::size_t at, std::string& bytes) {
    using enum StreamDamage::What;
    if (at >= bytes.size()) return;
    switch (damage.what) {
      case kBit:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << damage.number % 8));
        break;
      case kByte:
        bytes[at] = static_cast<char>(damage.number);
        break;
      case kCut:
      case kSilence:
        bytes.resize(at);
        break;
      case kLost:
        bytes.erase(at, 1 + damage.number % 32);
        break;
      case kMore:
        bytes.insert(at, std::string(1 + damage.number % 200, static_cast<char>(damage.number)));
        break;
      case kTwice:
        bytes.insert(at, bytes.substr(at, 1 + damage.number % 200));
        break;
      case kLength:
        for (std::size_t i = at; i < std::min(bytes.size(), at + (2u << damage.number % 3)); ++i)
          bytes[i] = static_cast<char>(i == at ? 0x7f : 0xff);
        break;
      case kPieces:
        break;
    }
  }

  LocalListener listener_;
  std::uint16_t server_;
  std::vector<StreamDamage> damages_;
  Descriptor over_, end_;
  std::thread thread_;
};

}  // namespace probe::campaign
