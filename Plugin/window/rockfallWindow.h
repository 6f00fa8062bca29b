#pragma once

/// Called once by ParaView's window when it has loaded the plugin.
void rockfallWindow();
