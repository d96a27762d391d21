#include "runtime/wire/tls_served.h"

#include <openssl/x509err.h>

#include <boost/asio/ssl.hpp>
#include <filesystem>

namespace probe::wire::beast_io {

namespace ssl = boost::asio::ssl;

struct TlsIdentity::Parts {
  ssl::context context{ssl::context::tls_server};
};

TlsIdentity::TlsIdentity(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
TlsIdentity::~TlsIdentity() = default;

Result<std::shared_ptr<TlsIdentity>> TlsIdentity::read(const TlsFiles& files) {
  const auto refused = [](const std::string& why, const std::string& file) {
    return Failure{Fault::kUsage, why, file};
  };
  for (const std::string& file : {files.certificate, files.key}) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) return refused("is no file", file);
  }
  auto parts = std::make_unique<Parts>();
  ssl::context& context = parts->context;
  SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
  boost::system::error_code error;
  context.use_certificate_chain_file(files.certificate, error);
  if (error) return refused("holds no certificate (PEM): " + error.message(), files.certificate);
  context.use_private_key_file(files.key, ssl::context::pem, error);
  const int reason = ERR_GET_REASON(static_cast<unsigned long>(error.value()));
  if (reason == X509_R_KEY_VALUES_MISMATCH || reason == X509_R_KEY_TYPE_MISMATCH)
    return refused("is not the key of the certificate `" + files.certificate + "`", files.key);
  if (error) return refused("holds no key (PEM): " + error.message(), files.key);
  return std::shared_ptr<TlsIdentity>(new TlsIdentity(std::move(parts)));
}

struct ServedTlsStream::Parts {
  Parts(boost::asio::ip::tcp::socket& socket, std::shared_ptr<TlsIdentity> shown,
        ssl::context& context)
      : identity(std::move(shown)), stream(socket, context) {}
  std::shared_ptr<TlsIdentity> identity;
  ssl::stream<boost::asio::ip::tcp::socket&> stream;
};

ServedTlsStream::ServedTlsStream(boost::asio::ip::tcp::socket& socket,
                                 std::shared_ptr<TlsIdentity> identity) {
  ssl::context& context = identity->parts_->context;
  parts_ = std::make_unique<Parts>(socket, std::move(identity), context);
}
ServedTlsStream::~ServedTlsStream() = default;

void ServedTlsStream::handshake(Error& error) {
  parts_->stream.handshake(ssl::stream_base::server, error);
}
std::size_t ServedTlsStream::read_some(boost::asio::mutable_buffer buffer, Error& error) {
  return parts_->stream.read_some(buffer, error);
}
std::size_t ServedTlsStream::write_some(boost::asio::const_buffer buffer, Error& error) {
  return parts_->stream.write_some(buffer, error);
}
void ServedTlsStream::shutdown(Error& error) { parts_->stream.shutdown(error); }

}  // namespace probe::wire::beast_io
