#include "spherical_actuator_calibration/ros/conversion/file_checksum.hpp"

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include <openssl/evp.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr std::size_t kPieceSize = std::size_t{1} << 20U;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    require(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void add(const char* data, std::size_t size) {
    require(EVP_DigestUpdate(context_.get(), data, size) == 1);
  }

  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes = {};
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size) == 1);
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (unsigned int k = 0; k < size; ++k) {
      text += kDigits[bytes[k] >> 4U];
      text += kDigits[bytes[k] & 0xFU];
    }
    return text;
  }

 private:
  static void require(bool done) {
    if (!done) {
      throw DataError("No checksum can be made: this system's OpenSSL refuses SHA-256.");
    }
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string fileChecksum(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Sha256 digest;
  std::vector<char> piece(kPieceSize);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    digest.add(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) {
    throw DataError(path + ": cannot be read.");
  }
  return "sha256:" + digest.hexadecimal();
}

}  // namespace sac
