# Script: says on standard error why a build has no charts; nothing when it has them.
#   cmake -DMISSING=build/charts/missing.txt -P charts_notice.cmake
if(EXISTS "${MISSING}")
  file(READ "${MISSING}" why)
  if(why)
    message("HTML reports will have no charts: ${why}")
  endif()
endif()
