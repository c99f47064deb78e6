#include "spherical_actuator_calibration/drivers/register_field.hpp"

namespace sac {

RegisterField readRegisterField(const YamlMap& map) {
  constexpr std::int64_t kLargestUnit = 247;
  RegisterField field;
  field.unit = static_cast<int>(map.integer("unit", 0, kLargestUnit, field.unit));
  const std::string table = map.choice("table", {"holding", "input"}, "holding");
  field.table = table == "input" ? RegisterTable::kInput : RegisterTable::kHolding;
  field.address = static_cast<int>(map.integer("address", 0, kLargestAddress));
  field.type =
      registerTypeFromName(map.choice("type", {"int16", "uint16", "int32", "uint32", "float32"}));
  const std::string order = map.choice("word_order", {"high_first", "low_first"}, "high_first");
  field.order = order == "low_first" ? WordOrder::kLowFirst : WordOrder::kHighFirst;
  field.scale = map.number("scale", ValueRange::positive());
  field.zero = map.number("zero", ValueRange::finite(), 0.0);
  field.sign = static_cast<int>(map.integer("sign", -1, 1, 1));
  if (field.sign == 0) {
    map.fail("sign", "0 is neither 1 nor -1.");
  }
  return field;
}

}  // namespace sac
