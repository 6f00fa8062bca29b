#include "solve/island/crowdSweep.h"

namespace rockfall::crowd
{

const Kernel kAnywhere = kernelHere;

#ifndef ROCKFALL_AVX2
const Kernel kAvx2 = kernelHere;
#endif
#ifndef ROCKFALL_AVX512
const Kernel kAvx512 = kernelHere;
#endif

const Kernel& suitedKernel()
{
#ifdef ROCKFALL_AVX512
  static const bool hasAvx512 = __builtin_cpu_supports("avx512f") &&
    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (hasAvx512)
  {
    return kAvx512;
  }
#endif
#ifdef ROCKFALL_AVX2
  static const bool hasAvx2 = __builtin_cpu_supports("avx2");
  return hasAvx2 ? kAvx2 : kAnywhere;
#else
  return kAnywhere;
#endif
}

} // namespace rockfall::crowd
