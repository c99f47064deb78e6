#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Samples measured by any means, written down by hand or by a script.
///
/// The form, with the optional keys in brackets; lists have one entry per joint, coil or component:
///
///     samples:
///       - joint_position: [q1, q2, q3]        # raw sensor angles [rad]; none without joints
///         [joint_stddev: [s1, s2, s3]]        # [rad], default 0
///         [orientation_xyzw: [x, y, z, w]]    # rotor to stator, unit to 1e-3
///         [orientation_stddev: s]             # per component [rad], default 0: not stated
///         [torque: [x, y, z]]                 # on the rotor, rotor frame [N·m]
///         [torque_stddev: s]                  # per component [N·m], default 0: not stated
///         [torque_shared_stddev: s]           # part of it that the dwell's torques share [N·m]
///         [current: [i1, i2, ...]]            # per coil [A], needed with torque
///         [validation: true]                  # held out, default false
///     [orientation_stddev: s]                 # default for all samples
///     [torque_stddev: s]
///     [provenance: text]                      # where the measurements come from
///
/// Ids count from 1 in the order of the file.
///
/// Throws ConfigError, naming file, line and key, when the file is not of this form, DataError when
/// a sample cannot be used with `coils` coils. Where the rotor has no joints there must be an
/// orientation instead of their angles.
std::vector<Sample> loadSamples(const std::string& path, std::size_t coils, bool has_joints = true);

}  // namespace sac
