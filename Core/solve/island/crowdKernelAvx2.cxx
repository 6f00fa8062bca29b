// Compiled for processors with AVX2, where the compiler and the processor it is for have that.
#ifdef ROCKFALL_AVX2

#include "solve/island/crowdSweep.h"

namespace rockfall::crowd
{

const Kernel kAvx2 = kernelHere;

} // namespace rockfall::crowd

#endif
