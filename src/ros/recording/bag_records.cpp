#include "bag_records.hpp"

namespace sac {
namespace {

/// The bytes that a length at `offset` says, after it. Advances the offset.
std::string_view lengthPrefixed(std::string_view bytes, std::size_t& offset) {
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
    const std::string_view field = lengthPrefixed(bytes, offset);
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

std::string_view MessageRecords::messageAt(std::string_view chunk, std::size_t offset) {
  const std::string_view header = lengthPrefixed(chunk, offset);
  const std::string_view message = lengthPrefixed(chunk, offset);
  if (!isAsBefore(header)) {
    verify(header);
  }
  return message;
}

bool MessageRecords::isAsBefore(std::string_view header) const {
  if (header.size() != verified_.size() || header.empty()) {
    return false;
  }
  const std::size_t after = time_offset_ + time_size_;
  return std::memcmp(header.data(), verified_.data(), time_offset_) == 0 &&
         std::memcmp(header.data() + after, verified_.data() + after, header.size() - after) == 0;
}

void MessageRecords::verify(std::string_view header) {
  verified_.clear();
  const BagFields fields(header);
  fields.requireOp(BagOp::kMessageData);
  if (fields.number<std::uint32_t>("conn") != connection_) {
    throw BagDefect("its index points to a message of another connection");
  }
  const std::string_view time = fields.text("time");
  time_offset_ = time.empty() ? 0 : static_cast<std::size_t>(time.data() - header.data());
  time_size_ = time.size();
  verified_ = header;
}

}  // namespace sac
