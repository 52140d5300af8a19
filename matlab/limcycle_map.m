function result = limcycle_map (what, varargin)
% LIMCYCLE_MAP  Behaviour over a plane of two parameters.
%   RESULT = LIMCYCLE_MAP (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('map', what, varargin{:});
end
