function result = limcycle_identify (what, varargin)
% LIMCYCLE_IDENTIFY  The friction law of measured records.
%   RESULT = LIMCYCLE_IDENTIFY (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('identify', what, varargin{:});
end
