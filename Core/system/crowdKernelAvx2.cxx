// Compiled for processors with AVX2, where the compiler and the processor it is for have that.
#ifdef ROCKFALL_AVX2

#include "system/crowdSweep.h"

namespace rockfall::crowd
{

double sweepAvx2(const Pass& pass)
{
  return pass.slope ? sweepAll<true>(pass) : sweepAll<false>(pass);
}

} // namespace rockfall::crowd

#endif
