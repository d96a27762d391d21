#include "runtime/wire/tls.h"

#include <openssl/x509v3.h>

#include <array>
#include <boost/asio/ssl.hpp>
#include <cstdlib>
#include <filesystem>

#include "runtime/base/printable.h"

namespace probe::wire::beast_io {
namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;

// What a certificate's text may say in a message.
constexpr std::size_t kLongestName = 200;

// "2024-05-01 12:00 UTC".
std::string time_text(const ASN1_TIME* time) {
  std::tm parts{};
  if (time == nullptr || ASN1_TIME_to_tm(time, &parts) != 1) return "an unknown time";
  char text[32];
  return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts));
}

// Where systems other than the one that OpenSSL was built for keep the authorities that they trust: Debian's and SUSE's
// own, Red Hat's, Alpine's. A variable that names them elsewhere is heeded alone.
constexpr std::array kSystemAuthorities = {"/etc/ssl/certs/ca-certificates.crt", "/etc/pki/tls/certs/ca-bundle.crt",
                                           "/etc/ssl/ca-bundle.pem", "/etc/ssl/cert.pem"};

void add_system_authorities(ssl::context& context) {
  std::error_code none;
  if (std::getenv(X509_get_default_cert_file_env()) != nullptr ||
      std::getenv(X509_get_default_cert_dir_env()) != nullptr ||
      std::filesystem::is_directory(X509_get_default_cert_dir(), none))
    return;
  for (const char* file : kSystemAuthorities) {
    boost::system::error_code unread;
    if (!std::filesystem::is_regular_file(file, none)) continue;
    context.load_verify_file(file, unread);
    if (!unread) return;
  }
}

// The hosts that a certificate is for: "a.example, 10.0.0.1".
std::string hosts_of(X509* certificate) {
  std::string hosts;
  const auto add = [&](const std::string& host) { hosts += (hosts.empty() ? "" : ", ") + host; };
  const auto free_names = [](GENERAL_NAMES* names) { GENERAL_NAMES_free(names); };
  const std::unique_ptr<GENERAL_NAMES, decltype(free_names)> names(
      static_cast<GENERAL_NAMES*>(
          X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)),
      free_names);
  for (int i = 0; names && i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(names.get(), i);
    if (name->type == GEN_DNS) {
      add({reinterpret_cast<const char*>(ASN1_STRING_get0_data(name->d.dNSName)),
           static_cast<std::size_t>(ASN1_STRING_length(name->d.dNSName))});
    } else if (name->type == GEN_IPADD) {
      const unsigned char* ip = ASN1_STRING_get0_data(name->d.iPAddress);
      const int size = ASN1_STRING_length(name->d.iPAddress);
      if (size == 4) {
        add(asio::ip::address_v4({ip[0], ip[1], ip[2], ip[3]}).to_string());
      } else if (size == 16) {
        asio::ip::address_v6::bytes_type bytes;
        std::copy_n(ip, bytes.size(), bytes.begin());
        add(asio::ip::address_v6(bytes).to_string());
      }
    }
  }
  return hosts.empty() ? "no host" : printable(hosts, kLongestName);
}

}  // namespace

struct TlsStream::Parts {
  Parts(asio::ip::tcp::socket& socket, const Endpoint& asked)
      : server(asked), context(ssl::context::tls_client), stream(socket, prepared(asked)) {}

  // The stream takes its settings from the context when it is made.
  ssl::context& prepared(const Endpoint& asked) {
    SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
    if (asked.tls.accepts_any) {
      context.set_verify_mode(ssl::verify_none);
      return context;
    }
    context.set_verify_mode(ssl::verify_peer);
    if (asked.tls.authorities.empty()) {
      context.set_default_verify_paths();  // and SSL_CERT_FILE, SSL_CERT_DIR
      add_system_authorities(context);
    } else {
      context.load_verify_file(asked.tls.authorities);
    }
    context.set_verify_callback([this](bool is_fine, ssl::verify_context& at) {
      if (!is_fine && !distrust) distrust = said_of(at.native_handle());
      return is_fine;
    });
    return context;
  }

  // What is wrong with the certificate that the chain's check met, and what can be done.
  std::string said_of(X509_STORE_CTX* at) const {
    X509* certificate = X509_STORE_CTX_get_current_cert(at);
    const int code = X509_STORE_CTX_get_error(at);
    switch (code) {
      case X509_V_ERR_CERT_HAS_EXPIRED:
        return "the certificate expired on " + time_text(X509_get0_notAfter(certificate)) + kAccept;
      case X509_V_ERR_CERT_NOT_YET_VALID:
        return "the certificate is not valid before " +
               time_text(X509_get0_notBefore(certificate)) + ": is this machine's clock right?";
      case X509_V_ERR_HOSTNAME_MISMATCH:
      case X509_V_ERR_IP_ADDRESS_MISMATCH:
        return "the certificate is for " + hosts_of(certificate) + ", not for " + server.host +
               kAccept;
      case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
        return "the certificate is self-signed" + trust();
      case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
      case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
      case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
      case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
        return "the certificate is signed by none of " +
               (server.tls.authorities.empty() ? std::string("the system's authorities")
                                               : "`" + server.tls.authorities + "`") +
               trust();
      default:
        return std::string("the certificate does not fit: ") + X509_verify_cert_error_string(code) +
               kAccept;
    }
  }

  static constexpr const char* kAccept = "; --insecure accepts any";
  std::string trust() const {
    return server.tls.authorities.empty()
               ? std::string(
                     "; trust its signer by ?ca=FILE or SSL_CERT_FILE, or accept any with "
                     "--insecure")
               : std::string(kAccept);
  }

  Endpoint server;
  std::optional<std::string> distrust;  // the first
  ssl::context context;
  ssl::stream<asio::ip::tcp::socket&> stream;
};

TlsStream::TlsStream(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
TlsStream::~TlsStream() = default;

Result<std::unique_ptr<TlsStream>> TlsStream::over(asio::ip::tcp::socket& socket,
                                                   const Endpoint& server) {
  if (std::error_code none; !server.tls.authorities.empty() &&
                            !std::filesystem::is_regular_file(server.tls.authorities, none)) {
    return Failure{Fault::kUsage, "`ca` names no file", server.tls.authorities};
  }
  std::unique_ptr<Parts> parts;
  try {
    parts = std::make_unique<Parts>(socket, server);
  } catch (const boost::system::system_error& error) {
    return Failure{Fault::kUsage,
                   "holds no certificates (PEM) that can be read: " + error.code().message(),
                   server.tls.authorities};
  }
  SSL* handle = parts->stream.native_handle();
  boost::system::error_code no_address;
  asio::ip::make_address(server.host, no_address);
  X509_VERIFY_PARAM* wanted = SSL_get0_param(handle);
  // Certificates know no scope ("fe80::1%eth0").
  const std::string address = server.host.substr(0, server.host.find('%'));
  bool is_set;
  if (no_address) {
    SSL_set_tlsext_host_name(handle, server.host.c_str());  // which of a machine's hosts is asked
    is_set = X509_VERIFY_PARAM_set1_host(wanted, server.host.c_str(), 0) == 1;
  } else {
    is_set = X509_VERIFY_PARAM_set1_ip_asc(wanted, address.c_str()) == 1;
  }
  if (!is_set)
    return Failure{Fault::kUsage, "no certificate can be of `" + server.host + "`", server.name()};
  return std::unique_ptr<TlsStream>(new TlsStream(std::move(parts)));
}

// Whether a server that closes is heard to end the stream or to reset the connection is a race with
// what we still send: both are a connection that ended without TLS's own end.
static TlsStream::DoneBytes told_as_cut(TlsStream::DoneBytes done) {
  return [done = std::move(done)](TlsStream::Error error, std::size_t bytes) {
    const bool is_reset = error == asio::error::connection_reset ||
                          error == asio::error::broken_pipe ||
                          error == asio::error::connection_aborted;
    done(is_reset ? boost::system::error_code(ssl::error::stream_truncated) : error, bytes);
  };
}

void TlsStream::async_handshake(Done done) {
  parts_->stream.async_handshake(ssl::stream_base::client, std::move(done));
}
void TlsStream::async_read_some(asio::mutable_buffer buffer, DoneBytes done) {
  parts_->stream.async_read_some(buffer, told_as_cut(std::move(done)));
}
void TlsStream::async_write_some(asio::const_buffer buffer, DoneBytes done) {
  parts_->stream.async_write_some(buffer, told_as_cut(std::move(done)));
}
void TlsStream::async_shutdown(Done done) { parts_->stream.async_shutdown(std::move(done)); }

Failure TlsStream::refusal(const Error& error) const {
  const std::string where = parts_->server.name();
  if (parts_->distrust) return {Fault::kAnswered, *parts_->distrust, where};
  if (const auto said = said_by_tls(error)) return {Fault::kAnswered, *said, where};
  const int reason = ERR_GET_REASON(static_cast<unsigned long>(error.value()));
  const bool is_ssl = error.category() == asio::error::get_ssl_category();
  if (is_ssl && (reason == SSL_R_WRONG_VERSION_NUMBER || reason == SSL_R_PACKET_LENGTH_TOO_LONG ||
                 reason == SSL_R_HTTP_REQUEST)) {
    return {Fault::kAnswered,
            "what listens there does not speak TLS: its address begins with ws:// or http://",
            where};
  }
  if (is_cut_off(error) || error == asio::error::eof || error == asio::error::connection_reset ||
      error == asio::error::broken_pipe) {
    return {Fault::kPolicy,
            "opening TLS: the server closed the connection; does it speak TLS, of 1.2 or newer and "
            "without a certificate of its clients?",
            where};
  }
  return {Fault::kPolicy, "opening TLS: " + error.message(), where};
}

std::optional<std::string> said_by_tls(const boost::system::error_code& error) {
  if (error.category() != asio::error::get_ssl_category()) return std::nullopt;
  switch (ERR_GET_REASON(static_cast<unsigned long>(error.value()))) {
    case SSL_R_TLSV13_ALERT_CERTIFICATE_REQUIRED:
      return "the server wants a certificate of its clients (mutual TLS), and vlaprobe has none";
    case SSL_R_SSLV3_ALERT_HANDSHAKE_FAILURE:
    case SSL_R_SSLV3_ALERT_BAD_CERTIFICATE:
      return "the server ended TLS's handshake: it may want a certificate of its clients (mutual "
             "TLS), of which vlaprobe has none, or other ciphers";
    case SSL_R_TLSV1_ALERT_PROTOCOL_VERSION:
    case SSL_R_UNSUPPORTED_PROTOCOL:
      return "the server speaks an older TLS than 1.2, the oldest that is taken";
    default:
      return std::nullopt;
  }
}

bool is_cut_off(const boost::system::error_code& error) {
  return error == ssl::error::stream_truncated;
}

}  // namespace probe::wire::beast_io
