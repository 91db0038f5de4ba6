#include "problems/fusion/fusion_engine.hpp"
#include "problems/fusion/fusion_states.hpp"

namespace odobench {

FusionResult fuse_augmented(const Recording& recording, const ConstVectorRef& z,
                            std::span<const SensorStream> sensors, const FusionOptions& options,
                            bool keep_innovations) {
  return FusionEngine<RobotModel<true, true, true>>(recording, z, sensors, options, keep_innovations).run();
}

}  // namespace odobench
