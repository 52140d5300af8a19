function result = limcycle_sensitivity (what, varargin)
% LIMCYCLE_SENSITIVITY  How the cycle moves with every parameter.
%   RESULT = LIMCYCLE_SENSITIVITY (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('sensitivity', what, varargin{:});
end
