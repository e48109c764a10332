# A phantom NAME, tracked and fitted with the radial kernel KERNEL (cauchy if not defined), as FOLDER/NAME.lumen or, with a
# KERNEL, FOLDER/NAME_KERNEL.lumen.
file(MAKE_DIRECTORY ${FOLDER})
set(stem ${FOLDER}/${NAME})
set(kernel "")
if(DEFINED KERNEL)
  string(APPEND stem _${KERNEL})
  set(kernel --kernel ${KERNEL})
endif()
execute_process(COMMAND ${LUMEN} phantom ${NAME} ${stem}.nrrd --seeds ${stem}.json --quiet
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${LUMEN} convert ${stem}.nrrd ${stem}.lumen --seeds ${stem}.json --seeds-only --quiet ${kernel}
  COMMAND_ERROR_IS_FATAL ANY)
