// Compiled for processors with AVX-512, where the compiler and the processor it is for have that.
#ifdef ROCKFALL_AVX512

#include "solve/island/crowdSweep.h"

namespace rockfall::crowd
{

const Kernel kAvx512 = kernelHere;

} // namespace rockfall::crowd

#endif
