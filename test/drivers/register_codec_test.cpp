#include "spherical_actuator_calibration/drivers/register_codec.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

using Words = std::vector<std::uint16_t>;

TEST(RegisterCodec, KeepsTheWordsOfKnownNumbers) {
  EXPECT_EQ(encodeRegisters(-2.0, RegisterType::kInt16, WordOrder::kHighFirst), Words{0xFFFE});
  EXPECT_EQ(encodeRegisters(40000.0, RegisterType::kUint16, WordOrder::kHighFirst), Words{40000});
  EXPECT_EQ(encodeRegisters(-2.0, RegisterType::kInt32, WordOrder::kHighFirst),
            (Words{0xFFFF, 0xFFFE}));
  EXPECT_EQ(encodeRegisters(65537.0, RegisterType::kUint32, WordOrder::kLowFirst), (Words{1, 1}));
  // 1.5 is 0x3FC00000 in IEEE 754.
  EXPECT_EQ(encodeRegisters(1.5, RegisterType::kFloat32, WordOrder::kHighFirst),
            (Words{0x3FC0, 0x0000}));
  EXPECT_EQ(encodeRegisters(1.5, RegisterType::kFloat32, WordOrder::kLowFirst),
            (Words{0x0000, 0x3FC0}));
}

TEST(RegisterCodec, ReadsBackWhatItWrote) {
  for (const WordOrder order : {WordOrder::kHighFirst, WordOrder::kLowFirst}) {
    for (const RegisterType type :
         {RegisterType::kInt16, RegisterType::kInt32, RegisterType::kFloat32}) {
      for (const double value : {-32768.0, -1.0, 0.0, 7.0, 32767.0}) {
        const Words words = encodeRegisters(value, type, order);
        ASSERT_EQ(words.size(), wordCount(type));
        EXPECT_EQ(decodeRegisters(words.data(), type, order), value) << registerTypeName(type);
      }
    }
  }
}

TEST(RegisterCodec, RoundsToTheNearestWholeNumber) {
  const Words words = encodeRegisters(-2.6, RegisterType::kInt16, WordOrder::kHighFirst);
  EXPECT_EQ(decodeRegisters(words.data(), RegisterType::kInt16, WordOrder::kHighFirst), -3.0);
}

TEST(RegisterCodec, RefusesWhatDoesNotFit) {
  const auto encode = [](double value, RegisterType type) {
    return encodeRegisters(value, type, WordOrder::kHighFirst);
  };
  EXPECT_THROW(encode(32768.0, RegisterType::kInt16), DataError);
  EXPECT_THROW(encode(-1.0, RegisterType::kUint16), DataError);
  EXPECT_THROW(encode(3e9, RegisterType::kInt32), DataError);
  EXPECT_THROW(encode(1e39, RegisterType::kFloat32), DataError);
  EXPECT_THROW(encode(std::nan(""), RegisterType::kInt16), DataError);
  EXPECT_THROW(encode(std::nan(""), RegisterType::kFloat32), DataError);
}

TEST(RegisterCodec, NamesItsTypes) {
  for (const char* name : {"int16", "uint16", "int32", "uint32", "float32"}) {
    EXPECT_EQ(registerTypeName(registerTypeFromName(name)), name);
  }
  EXPECT_THROW(registerTypeFromName("float64"), ConfigError);
}

}  // namespace
}  // namespace sac
