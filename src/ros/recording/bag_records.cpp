#include "bag_records.hpp"

namespace sac {
namespace {

constexpr std::size_t kLengthSize = sizeof(std::uint32_t);

/// The bytes that a length at `offset` says, after it. Advances the offset.
std::string_view counted(std::string_view bytes, std::size_t& offset) {
  if (offset > bytes.size() || bytes.size() - offset < kLengthSize) {
    throw BagDefect("a record is cut");
  }
  const std::size_t length = numberAt<std::uint32_t>(bytes, offset);
  offset += kLengthSize;
  if (bytes.size() - offset < length) {
    throw BagDefect("a record says that it is longer than what is there");
  }
  const std::string_view part = bytes.substr(offset, length);
  offset += length;
  return part;
}

}  // namespace

BagFields::BagFields(std::string_view bytes) {
  std::size_t offset = 0;
  while (offset < bytes.size()) {
    const std::string_view field = counted(bytes, offset);
    const std::size_t sign = field.find('=');
    if (sign == std::string_view::npos) {
      throw BagDefect("a field of a record has no name");
    }
    const std::string_view name = field.substr(0, sign);
    for (const auto& [known, value] : fields_) {
      if (known == name) {
        throw BagDefect("a field of a record comes twice");
      }
    }
    fields_.emplace_back(name, field.substr(sign + 1));
  }
}

std::string_view BagFields::text(std::string_view name) const {
  for (const auto& [known, value] : fields_) {
    if (known == name) {
      return value;
    }
  }
  return {};
}

void BagFields::requireOp(BagOp op) const {
  if (this->op() != op) {
    throw BagDefect("a record of kind " + std::to_string(number<std::uint8_t>("op")) +
                    " stands where one of kind " + std::to_string(static_cast<int>(op)) +
                    " must be");
  }
}

BagRecord recordAt(std::string_view bytes, std::size_t offset) {
  const std::string_view header = counted(bytes, offset);
  const std::string_view data = counted(bytes, offset);
  return {BagFields(header), data, offset};
}

}  // namespace sac
