#include "problems/fusion/fusion_engine.hpp"
#include "problems/fusion/fusion_states.hpp"

namespace odobench {

FusionResult fuse_plain(const Recording& recording, const ConstVectorRef& z,
                        std::span<const SensorStream> sensors, const FusionOptions& options,
                        bool keep_innovations) {
  return FusionEngine<RobotModel<false, false, false>>(recording, z, sensors, options, keep_innovations)
      .run();
}

}  // namespace odobench
