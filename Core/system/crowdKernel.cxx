#include "system/crowdSweep.h"

namespace rockfall::crowd
{

double sweepAnywhere(const Pass& pass)
{
  return pass.slope ? sweepAll<true>(pass) : sweepAll<false>(pass);
}

#ifndef ROCKFALL_AVX2
double sweepAvx2(const Pass& pass)
{
  return sweepAnywhere(pass);
}
#endif

Sweep suitedSweep()
{
#ifdef ROCKFALL_AVX2
  static const Sweep suited = __builtin_cpu_supports("avx2") ? sweepAvx2 : sweepAnywhere;
  return suited;
#else
  return sweepAnywhere;
#endif
}

} // namespace rockfall::crowd
