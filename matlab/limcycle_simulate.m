function result = limcycle_simulate (what, varargin)
% LIMCYCLE_SIMULATE  A run in time, with located events.
%   RESULT = LIMCYCLE_SIMULATE (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('simulate', what, varargin{:});
end
