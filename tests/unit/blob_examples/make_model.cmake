# A phantom NAME, tracked and fitted, as FOLDER/NAME.lumen.
file(MAKE_DIRECTORY ${FOLDER})
set(stem ${FOLDER}/${NAME})
execute_process(COMMAND ${LUMEN} phantom ${NAME} ${stem}.nrrd --seeds ${stem}.json --quiet
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${LUMEN} convert ${stem}.nrrd ${stem}.lumen --seeds ${stem}.json --seeds-only --quiet
  COMMAND_ERROR_IS_FATAL ANY)
