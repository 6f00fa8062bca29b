#include "base/text/columnName.h"

#include <gtest/gtest.h>

using rockfall::ColumnName;

TEST(ColumnName, hasItsUnitInBracketsOrAsAWordOfItsOwn)
{
  const struct
  {
    const char *written, *name, *unit;
  } cases[] = {
    { "Elevation (ft)", "elevation", "ft" },
    { "Z [m]", "z", "m" },
    { "Höhe [NHN]", "höhe", "nhn" },
    { "ELEV_FT", "elev", "ft" },
    { "elev-ft", "elev", "ft" },
    { "elev.ft", "elev", "ft" },
    { "elev ft", "elev", "ft" },
    { "elevFt", "elev", "ft" },
    { "elev_in_feet", "elev", "feet" },
    { "Elevation in metres", "elevation", "metres" },
    { "Z_FT_NAVD88", "z", "ft" },
    { "elev_ft_msl", "elev", "ft" },
    { "elev_in", "elev", "in" },
    { "elev_in_line", "elev_in_line", "" },
    { "ELEV_USFT", "elev", "usft" },
    { "elev_ftUS", "elev", "ft us" },
    { "elev_us_ft", "elev", "us ft" },
    { "elev_us_survey_feet", "elev", "us survey feet" },
    { "elev_centimetre", "elev", "centimetre" },
    { "ft", "ft", "" },
    { "m", "m", "" },
    { "shaft", "shaft", "" },
    { "left", "left", "" },
    { "dm_number", "dm_number", "" },
    { "x", "x", "" },
  };
  for (const auto& c : cases)
  {
    const ColumnName column(c.written);
    EXPECT_EQ(column.name, c.name) << c.written;
    EXPECT_EQ(column.unit, c.unit) << c.written;
  }
}
